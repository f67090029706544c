// color_table.h -- light as the sums of a film, XYZ and then the channels of a sensor: of one wavelength, or of a spectrum
// that is linear between some nodes.
#pragma once
#include <array>
#include <vector>

#include "spectrum/responses.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// XYZ and channels; as many as a SIMD register likes.
using FilmColor = std::array<float, 8>;
static_assert(3 + Responses::kMost <= 8);

/// How much of a wavelength that Wavelengths::sample drew is seen: |R| + |G| + |B| of white light, over the chance that it
/// was drawn; 1 in the mean.
float seen_light(float nm);

class ColorTable {
  public:
    explicit ColorTable(const Responses& responses);

    int values() const { return values_; }
    /// Adds `times` the color, per nm, of light (Rgb, as Wavelengths::emission takes it) at a wavelength.
    void add(FilmColor& color, Rgb light, float nm, float times) const;

    using Parts = std::array<FilmColor, 3>;   // of R, G and B
    /// Colours of the values of a spectrum at so many nodes, evenly over all wavelengths.
    std::vector<Parts> nodes(int count) const;

  private:
    int values_;
    std::vector<Parts> per_nm_;   // at each nm; linear between
};

}  // namespace dg
