// color_table.h -- converts light to the sums of a film, XYZ and sensor channels: light of a single wavelength, or of a
// piecewise linear spectrum.
#pragma once
#include <array>
#include <vector>

#include "spectrum/responses.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// XYZ and channels, padded to a SIMD register.
using FilmColor = std::array<float, 8>;
static_assert(3 + Responses::kMost <= 8);

/// Visibility of a wavelength sampled by Wavelengths::sample: |R| + |G| + |B| of white light over its density; the mean
/// is 1.
float seen_light(float nm);

class ColorTable {
  public:
    explicit ColorTable(const Responses& responses);

    int values() const { return values_; }
    /// Adds the color, per nm, of light at a wavelength, scaled by `times`. `light`: Rgb as for Wavelengths::emission.
    void add(FilmColor& color, Rgb light, float nm, float times) const;

    using Parts = std::array<FilmColor, 3>;   // for R, G and B
    /// Colours of the node values of a piecewise linear spectrum with `count` uniform nodes.
    std::vector<Parts> nodes(int count) const;

  private:
    int values_;
    std::vector<Parts> per_nm_;   // at each nm, interpolated linearly
};

}  // namespace dg
