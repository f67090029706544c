#include "optics/coating.h"

#include <algorithm>
#include <cmath>

#include "math/error.h"
#include "math/vec.h"

namespace dg {
namespace {

// 1 - |r|^2 of a film with admittances p (before), q (film), r (after) and round-trip
// phase 2b. From the Airy sum with r01 = (p-q)/(p+q), r12 = (q-r)/(q+r); only cos(2b) is
// left in it.
double airy_transmittance(double p, double q, double r, double cos_2b) {
    const double p2 = p * p, q2 = q * q, r2 = r * r, m = 4 * q2 * p * r;
    return 2 * m / ((p2 + q2) * (q2 + r2) + m + (p2 - q2) * (q2 - r2) * cos_2b);
}

}  // namespace

double fresnel_transmittance(double n1, double cos1, double n2, double cos2) {
    const double rs = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
    const double rp = (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2);
    return 1 - 0.5 * (rs * rs + rp * rp);
}

double film_transmittance(double n1, double cos1, double n2, double cos2,
                          double wavelength_nm) {
    const double nf = kFilmIndex,
                 sin_f = n1 / nf * std::sqrt(std::max(0.0, 1 - cos1 * cos1));
    const double cos_f = std::sqrt(std::max(0.0, 1 - sin_f * sin_f));
    const double cos_2b = std::cos(kPiD * kFilmWavelength / wavelength_nm * cos_f);
    const double ts = airy_transmittance(n1 * cos1, nf * cos_f, n2 * cos2, cos_2b);
    // p admittances n / cos, multiplied by all three cosines: the ratio does not change.
    const double tp = airy_transmittance(n1 * cos_f * cos2, nf * cos1 * cos2,
                                         n2 * cos1 * cos_f, cos_2b);
    return 0.5 * (ts + tp);
}

double surface_transmittance(Coating coating, double n1, double cos1, double n2,
                             double cos2, double wavelength_nm) {
    if (n1 == n2 || coating == Coating::perfect) return 1;
    if (coating == Coating::uncoated || (n1 != 1 && n2 != 1))
        return fresnel_transmittance(n1, cos1, n2, cos2);
    return film_transmittance(n1, cos1, n2, cos2, wavelength_nm);
}

Coating coating_from_name(const std::string& name) {
    if (name == "uncoated") return Coating::uncoated;
    if (name == "mgf2") return Coating::mgf2;
    if (name == "perfect") return Coating::perfect;
    throw input_error("coating", "name", "uncoated, mgf2 or perfect", name);
}

}  // namespace dg
