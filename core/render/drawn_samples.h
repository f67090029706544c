// drawn_samples.h -- which samples of which pixels one call draws: of a part of the film's region, the same of every
// pixel, or a round's own number of each.
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
    /// The settings outlive this.
    DrawnSamples(const RenderSettings& settings, const FilmLayout& film);

    /// The part of the film's region that is drawn, but for the hole.
    const FilmLayout& region() const { return region_; }
    /// Samples of each of its pixels; empty where all are alike, which needs no weighing (FilmDensity).
    std::span<const std::uint32_t> counts() const { return counts_; }
    /// Samples [begin, end) that this call draws of a pixel.
    std::array<std::uint32_t, 2> of(Pixel pixel) const;
    /// Sample indices per unit of the counts, which are those of a whole round.
    double per_count() const;
    /// Mean indices of the samples that this call begins and ends with: what light paths go by.
    std::array<double, 2> indices() const;

  private:
    const RenderSettings& settings_;
    FilmLayout film_, region_;
    std::vector<std::uint32_t> counts_;
};

}  // namespace dg
