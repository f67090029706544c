// coating.h -- how much light a surface lets through: thin films, exactly.
#pragma once
#include <string>
#include <vector>

namespace dg {

/// uncoated: bare glass. mgf2: one quarter wave of magnesium fluoride for 550 nm. v_coat:
/// two films that reflect nothing at 550 nm. broadband: three or four films that reflect
/// 0.2 to 0.4 % over 400-700 nm. perfect: nothing is reflected (for tests of geometry).
enum class Coating { uncoated, mgf2, v_coat, broadband, perfect };

inline constexpr double kFilmWavelength = 550;  // nm, for which single films are made

/// A film of n = a + b / um^2, and its thickness.
struct CoatingLayer {
    double a, b, thickness_nm;
    double index(double nm) const { return a + b * 1e6 / (nm * nm); }
};

/// Coating of one surface.
struct SurfaceCoating {
    bool reflects = true;     // false: no surface at all, or a perfect one
    std::vector<CoatingLayer> films;  // from the rarer medium to the glass; none: bare
    double mirror = 0;  // reflectance of a mirror in part: neither glass nor films count
};

/// Coating that a maker would put between two media, given their indices at 550 nm. Surfaces
/// between air (or another fluid) and glass are coated, cemented ones are bare.
SurfaceCoating coat(Coating coating, double n1, double n2);

/// Transmittance 1 - R of an interface, mean of s and p, from medium 1 to medium 2 or
/// back. Cosines are those of the ray in either medium, positive.
double surface_transmittance(const SurfaceCoating& coating, double n1, double cos1,
                             double n2, double cos2, double wavelength_nm);

/// Names: uncoated, mgf2, v-coat, broadband, perfect. Error names the choices.
Coating coating_from_name(const std::string& name);

}  // namespace dg
