#include "optics/lens/coating.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

#include "math/error.h"
#include "math/vec.h"

using namespace dg;

namespace {

constexpr Coating kAll[] = {Coating::uncoated, Coating::mgf2, Coating::v_coat,
                            Coating::broadband};

double normal_loss(Coating coating, double n, double nm) {
    return 1 - surface_transmittance(coat(coating, 1, n), 1, 1, n, 1, nm);
}

double mean_loss(Coating coating, double n) {
    double sum = 0;
    for (double nm = 400; nm <= 700; nm += 5) sum += normal_loss(coating, n, nm);
    return sum / 61;
}

/// R and T of a film stack by Rouard's recursion (the sum of all internal reflections, from the
/// glass outward, in complex amplitudes): independent of the characteristic matrices.
struct Rouard {
    double r = 0, t = 0;
};
Rouard rouard(const std::vector<CoatingLayer>& films, double n1, double cos1, double n2, double nm,
              bool s) {
    using Complex = std::complex<double>;
    std::vector<double> n{n1}, cosine{cos1}, phase{0};
    for (const CoatingLayer& f : films) {
        n.push_back(f.index(nm));
        cosine.push_back(std::sqrt(1 - std::pow(n1 / n.back(), 2) * (1 - cos1 * cos1)));
        phase.push_back(2 * kPiD / nm * n.back() * f.thickness_nm * cosine.back());
    }
    n.push_back(n2);
    cosine.push_back(std::sqrt(1 - std::pow(n1 / n2, 2) * (1 - cos1 * cos1)));
    Complex r = 0, t = 1;
    for (int k = int(films.size()); k >= 0; --k) {
        const double a = s ? n[k] * cosine[k] : n[k] / cosine[k];
        const double b = s ? n[k + 1] * cosine[k + 1] : n[k + 1] / cosine[k + 1];
        const Complex turn = k < int(films.size())
                                 ? std::exp(Complex(0, phase[k + 1]))
                                 : Complex(1);
        const double rk = (a - b) / (a + b), tk = 2 * a / (a + b);
        const Complex inner = r * turn * turn, denominator = 1.0 + rk * inner;
        t = tk * t * turn / denominator;
        r = (rk + inner) / denominator;
    }
    const double a = s ? n1 * cos1 : n1 / cos1;
    const double b = s ? n2 * cosine.back() : n2 / cosine.back();
    return {std::norm(r), std::norm(t) * b / a};
}

}  // namespace

TEST_CASE("published losses at normal incidence") {
    CHECK(normal_loss(Coating::uncoated, 1.52, 550) == doctest::Approx(0.0426).epsilon(2e-3));
    CHECK(normal_loss(Coating::mgf2, 1.52, 550) == doctest::Approx(0.0126).epsilon(4e-3));
    CHECK(normal_loss(Coating::perfect, 1.52, 550) == 0);
    // A V coat has no reflectance at its design wavelength, and more than a single film far from
    // it.
    for (const double n : {1.43, 1.5, 1.6, 1.7, 1.85})
        CHECK(normal_loss(Coating::v_coat, n, 550) < 1e-12);
    CHECK(normal_loss(Coating::v_coat, 2.0, 550) < 1e-3);
    CHECK(normal_loss(Coating::v_coat, 1.52, 400) > normal_loss(Coating::mgf2, 1.52, 400));
    for (double n = 1.43; n < 2.1; n += 0.02) {
        CHECK(mean_loss(Coating::broadband, n) < (n < 2 ? 0.0044 : 0.006));
        CHECK(mean_loss(Coating::mgf2, n) > mean_loss(Coating::broadband, n));
    }
    CHECK(mean_loss(Coating::broadband, 1.52) < 0.003);
}

TEST_CASE("R + T = 1, as the sum of all reflections says, for s and p") {
    for (const Coating coating : kAll)
        for (const double n : {1.38, 1.52, 1.75, 2.0})
            for (const double cos1 : {1.0, 0.9, 0.5, 0.1, 0.01})
                for (double nm = 380; nm <= 780; nm += 50) {
                    const SurfaceCoating films = coat(coating, 1, n);
                    const Rouard s = rouard(films.films, 1, cos1, n, nm, true);
                    const Rouard p = rouard(films.films, 1, cos1, n, nm, false);
                    CHECK(s.r + s.t == doctest::Approx(1).epsilon(1e-12));
                    CHECK(p.r + p.t == doctest::Approx(1).epsilon(1e-12));
                    const double cos2 = std::sqrt(1 - (1 - cos1 * cos1) / (n * n));
                    const double t = surface_transmittance(films, 1, cos1, n, cos2, nm);
                    CHECK(t == doctest::Approx(0.5 * (s.t + p.t)).epsilon(1e-11));
                    CHECK(t == surface_transmittance(films, n, cos2, 1, cos1, nm));
                }
}

TEST_CASE("what is coated: glass against fluids, not cement; grazing rays pass nothing") {
    CHECK(coat(Coating::broadband, 1.6, 1.7).films.empty());
    CHECK(coat(Coating::broadband, 1.6, 1.7).reflects);
    CHECK_FALSE(coat(Coating::broadband, 1.6, 1.6).reflects);
    CHECK(coat(Coating::mgf2, 1.333, 1.6).films.size() == 1);
    CHECK(coat(Coating::mgf2, 1, 1.333).films.empty());
    CHECK(coat(Coating::uncoated, 1, 1.6).films.empty());
    CHECK(surface_transmittance(coat(Coating::mgf2, 1, 1.5), 1, 0, 1.5, 0.75, 500) == 0);
    // A film with the index of the glass has no effect.
    const SurfaceCoating nothing{true, {{1.6, 0, 77}}};
    CHECK(surface_transmittance(nothing, 1, 0.7, 1.6, std::sqrt(1 - 0.51 / 2.56), 470) ==
          doctest::Approx(surface_transmittance({}, 1, 0.7, 1.6,
                                                std::sqrt(1 - 0.51 / 2.56), 470))
              .epsilon(1e-12));
    CHECK_THROWS_AS(coating_from_name("gold"), Error);
    CHECK(coating_from_name("v-coat") == Coating::v_coat);
}
