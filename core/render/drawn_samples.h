// drawn_samples.h -- the pixels and sample indices that a call of render() draws: a part of the film's region, with the
// same samples for every pixel, or with a number of samples per pixel from a round.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/dispersion.h"
#include "render/render.h"

namespace dg {

class DrawnSamples {
  public:
    /// `settings` must outlive this.
    DrawnSamples(const RenderSettings& settings, const FilmLayout& film);

    /// The part of the film's region that is drawn, including the hole.
    const FilmLayout& region() const { return region_; }
    /// Number of samples of each pixel; empty if all are equal, which needs no weights (FilmDensity).
    std::span<const std::uint32_t> counts() const { return counts_; }
    /// Samples [begin, end) that this call draws of a pixel.
    std::array<std::uint32_t, 2> of(Pixel pixel) const;
    /// Sample indices of this call per unit of the counts, which are for a whole round.
    double per_count() const;
    /// Mean first and last sample index of this call, which determine the light paths to draw.
    std::array<double, 2> indices() const;

  private:
    const RenderSettings& settings_;
    FilmLayout film_, region_;
    std::vector<std::uint32_t> counts_;
};

}  // namespace dg
