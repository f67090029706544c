// coating.h -- how much light a surface lets through.
#pragma once
#include <string>

namespace dg {

/// uncoated: bare glass. mgf2: one quarter-wave layer of magnesium fluoride (n = 1.38)
/// for 550 nm. perfect: nothing is reflected (for tests of geometry).
enum class Coating { uncoated, mgf2, perfect };

inline constexpr double kFilmIndex = 1.38;      // MgF2
inline constexpr double kFilmWavelength = 550;  // nm, quarter wave

/// Transmittance 1 - R of a bare interface, mean of s and p. Cosines are positive.
double fresnel_transmittance(double n1, double cos1, double n2, double cos2);

/// The same with the quarter-wave film between. Two-beam sum of all orders in the film
/// (Airy): r = (r01 + r12 e^{2ib}) / (1 + r01 r12 e^{2ib}), b = 2 pi nf d cos(theta_f) /
/// lambda.
double film_transmittance(double n1, double cos1, double n2, double cos2,
                          double wavelength_nm);

/// Interfaces between air and glass are coated, cemented ones are bare.
double surface_transmittance(Coating coating, double n1, double cos1, double n2,
                             double cos2, double wavelength_nm);

Coating coating_from_name(const std::string& name);  // Error names the choices

}  // namespace dg
