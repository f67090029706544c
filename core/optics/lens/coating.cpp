#include "optics/lens/coating.h"

#include <algorithm>
#include <cmath>

#include "math/error.h"
#include "math/vec.h"

namespace dg {
namespace {

/// Index between fluids (gases, vacuum, water), which get no coating, and optical solids.
constexpr double kDensestFluid = 1.36;

// Dispersion of film materials as evaporated. MgF2: the textbook value 1.38. Ta2O5: fit to Gao,
// Lemarchand and Lequime 2012, Opt. Express 20(14), 380-780 nm, within 0.007. Al2O3: fit to Boidin
// et al. 2016, Ceramics International 42, within 0.0004.
CoatingLayer mgf2(double nm) {
    return {1.38, 0, nm};
}
CoatingLayer ta2o5(double nm) {
    return {2.0643, 0.028715, nm};
}
CoatingLayer al2o3(double nm) {
    return {1.66083, 0.0065516, nm};
}

std::vector<CoatingLayer> quarter_wave() {
    return {mgf2(kFilmWavelength / (4 * 1.38))};
}

// Two-film antireflection coating: thicknesses at which the amplitudes cancel at kFilmWavelength
// (Macleod, Thin-Film Optical Filters, "two-layer antireflection coatings": tan^2 of both phases).
// The low-index film is the thicker, with a phase above a quarter wave. For glass of n >= 1.38^2, a
// single quarter wave reflects less than any such pair.
std::vector<CoatingLayer> v_coat(double glass) {
    const double low = mgf2(0).index(kFilmWavelength),
                 high = ta2o5(0).index(kFilmWavelength);
    const double l2 = low * low, h2 = high * high;
    if (glass >= l2) return quarter_wave();
    const double top = (glass - 1) / (l2 * glass - h2);
    const double phase_low =
        kPiD - atan(std::sqrt(top * (h2 - glass) * l2 / (glass - l2)));
    const double phase_high =
        atan(std::sqrt(top * (glass - l2) * h2 / (h2 - glass)));
    const double per_phase = kFilmWavelength / (2 * kPiD);
    return {mgf2(phase_low * per_phase / low), ta2o5(phase_high * per_phase / high)};
}

// Our designs, by least mean reflectance over 400-700 nm at normal incidence; thicknesses depend on
// the index of the glass. Up to 1.75: a quarter wave, nearly a half wave and two thin films of MgF2
// and Ta2O5, which reflect 0.17 to 0.42 %. Above 1.75, where the glass itself acts as a high-index
// film: three films of rising index, 0.32 to 0.42 % up to n = 2.0.
std::vector<CoatingLayer> broadband(double glass) {
    if (glass < 1.75) {
        const double g = glass - 1.43;
        return {mgf2(92.7 + 2.5 * g), ta2o5(123.1 + 17.2 * g), mgf2(35.7 - 45 * g),
                ta2o5(13.8 + 8.4 * g)};
    }
    const double g = glass - 1.75;
    return {mgf2(73.7 - 22 * g), al2o3(29.3 + 40 * g), ta2o5(108.6 - 4 * g)};
}

/// Characteristic matrix [[a, i b], [i c, d]] of a film stack for one polarization. n sin(theta) is
/// the same in all films. Source: Born and Wolf, Principles of Optics, section 1.6.
struct Characteristic {
    double a = 1, b = 0, c = 0, d = 1;

    void add(double cosine, double sine, double admittance) {
        const double b2 = sine / admittance, c2 = sine * admittance;
        *this = {a * cosine - b * c2, a * b2 + b * cosine, c * cosine + d * c2,
                 d * cosine - c * b2};
    }
    /// 4 p q / |p B + C|^2 with (B, C) = M (1, q), where p and q are the admittances of the media.
    double transmittance(double p, double q) const {
        const double real = p * a + q * d, imaginary = p * q * b + c;
        return 4 * p * q / (real * real + imaginary * imaginary);
    }
};

double films_transmittance(const std::vector<CoatingLayer>& films, double n1, double cos1,
                           double n2, double cos2, double nm) {
    const double sine2 = n1 * n1 * std::max(0.0, 1 - cos1 * cos1);
    Characteristic s, p;
    for (const CoatingLayer& film : films) {
        const double n = film.index(nm);
        const double normal = std::sqrt(std::max(0.0, n * n - sine2));  // n cos(theta)
        const double phase = 2 * kPiD * film.thickness_nm / nm * normal;
        const double cosine = std::cos(phase), sine = std::sin(phase);
        s.add(cosine, sine, normal);
        p.add(cosine, sine, n * n / normal);
    }
    // The p admittance n / cos diverges at grazing incidence, where T = 0.
    if (!(cos1 > 0 && cos2 > 0)) return 0;
    return 0.5 * (s.transmittance(n1 * cos1, n2 * cos2) +
                  p.transmittance(n1 / cos1, n2 / cos2));
}

double bare_transmittance(double n1, double cos1, double n2, double cos2) {
    const double rs = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
    const double rp = (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2);
    return 1 - 0.5 * (rs * rs + rp * rp);
}

}  // namespace

SurfaceCoating coat(Coating coating, double n1, double n2) {
    if (n1 == n2 || coating == Coating::perfect) return {.reflects = false, .films = {}};
    const double glass = std::max(n1, n2);
    const bool coated = std::min(n1, n2) < kDensestFluid && glass > kDensestFluid;
    if (!coated || coating == Coating::uncoated) return {};
    switch (coating) {
        case Coating::v_coat:
            return {.films = v_coat(glass)};
        case Coating::broadband:
            return {.films = broadband(glass)};
        default:
            return {.films = quarter_wave()};
    }
}

double surface_transmittance(const SurfaceCoating& coating, double n1, double cos1,
                             double n2, double cos2, double wavelength_nm) {
    if (coating.mirror > 0) return 1 - coating.mirror;
    if (!coating.reflects) return 1;
    if (coating.films.empty()) return bare_transmittance(n1, cos1, n2, cos2);
    if (n1 < n2)
        return films_transmittance(coating.films, n1, cos1, n2, cos2, wavelength_nm);
    return films_transmittance(coating.films, n2, cos2, n1, cos1, wavelength_nm);
}

Coating coating_from_name(const std::string& name) {
    if (name == "uncoated") return Coating::uncoated;
    if (name == "mgf2") return Coating::mgf2;
    if (name == "v-coat") return Coating::v_coat;
    if (name == "broadband") return Coating::broadband;
    if (name == "perfect") return Coating::perfect;
    throw input_error("coating", "name", "uncoated, mgf2, v-coat, broadband or perfect",
                      name);
}

}  // namespace dg
