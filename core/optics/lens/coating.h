// coating.h -- exact transmittance of a lens surface with a stack of thin films.
#pragma once
#include <string>
#include <vector>

namespace dg {

/// Preset coatings. uncoated: bare glass. mgf2: one quarter wave of magnesium fluoride at 550 nm.
/// v_coat: two films, zero reflectance at 550 nm. broadband: three or four films that reflect 0.2
/// to 0.4 % over 400-700 nm. perfect: zero reflectance (for tests of geometry).
enum class Coating { uncoated, mgf2, v_coat, broadband, perfect };

inline constexpr double kFilmWavelength = 550;  // nm, design wavelength of the single-wavelength coatings

/// Thin film with index n = a + b / um^2.
struct CoatingLayer {
    double a, b, thickness_nm;
    double index(double nm) const { return a + b * 1e6 / (nm * nm); }
};

/// Coating of one surface.
struct SurfaceCoating {
    bool reflects = true;     // false: an index-matched interface, or a perfect coating
    std::vector<CoatingLayer> films;  // ordered from the rarer medium to the glass; empty: bare
    double mirror = 0;  // reflectance of a partial mirror; replaces Fresnel and films
};

/// The preset's films between two media with the given indices at 550 nm. Only surfaces between a
/// fluid (air, water) and glass are coated; cemented surfaces stay bare.
SurfaceCoating coat(Coating coating, double n1, double n2);

/// Transmittance 1 - R of an interface, averaged over s and p polarization; the same in both
/// directions. cos1 and cos2 are the positive cosines of the ray in medium 1 and in medium 2.
double surface_transmittance(const SurfaceCoating& coating, double n1, double cos1,
                             double n2, double cos2, double wavelength_nm);

/// Parses uncoated, mgf2, v-coat, broadband or perfect; the Error lists these choices.
Coating coating_from_name(const std::string& name);

}  // namespace dg
