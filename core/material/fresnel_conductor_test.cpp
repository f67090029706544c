// fresnel_conductor_test.cpp -- metals against Fresnel's equations with complex numbers.
#include "material/fresnel_conductor.h"

#include <doctest/doctest.h>

#include <complex>

#include "material/bsdf_check.h"

namespace dg {
namespace {

using Complex = std::complex<double>;

/// |r_s|^2 and |r_p|^2 of Fresnel's equations, averaged.
double by_amplitudes(double cosine, Complex n) {
    const Complex cos_t = std::sqrt(1.0 - (1 - cosine * cosine) / (n * n));
    const Complex s = (cosine - n * cos_t) / (cosine + n * cos_t), p = (n * cosine - cos_t) / (n * cosine + cos_t);
    return 0.5 * (std::norm(s) + std::norm(p));
}

/// Indices of metals at four wavelengths: copper, gold, aluminium, tungsten (rounded).
const Spectrum kEta{0.25f, 0.43f, 0.96f, 3.5f}, kExtinction{3.4f, 2.5f, 6.7f, 2.7f};

template <typename Fresnel>
double largest_difference(Fresnel fresnel) {
    double worst = 0;
    for (const float c : {1.f, 0.9f, 0.7f, 0.5f, 0.3f, 0.1f, 0.02f, 0.f}) {
        const Spectrum r = fresnel(c);
        for (int k = 0; k < kWavelengths; ++k)
            worst = std::max(worst, std::abs(r[k] - by_amplitudes(c, {kEta[k], kExtinction[k]})));
    }
    return worst;
}

}  // namespace

TEST_CASE("a metal's reflectance is that of the amplitudes, at all angles") {
    CHECK(largest_difference([](float c) { return fresnel_conductor(c, kEta, kExtinction); }) < 2e-6);
    // Planted faults: no extinction, inverse index, Schlick's curve.
    CHECK(largest_difference([](float c) { return fresnel_conductor(c, kEta, 0.f); }) > 0.1);
    CHECK(largest_difference([](float c) { return fresnel_conductor(c, kExtinction, kEta); }) > 0.1);
    CHECK(largest_difference([](float c) {
              const Spectrum r = fresnel_conductor(1, kEta, kExtinction);
              return r + (Spectrum(1.f) - r) * schlick(c);
          }) > 0.01);
}

TEST_CASE("a metal without extinction is a dielectric, and all reflect everything at grazing angles") {
    for (const float c : {1.f, 0.6f, 0.2f}) {
        CHECK(fresnel_conductor(c, 1.5f, 0.f)[0] == doctest::Approx(fresnel_dielectric(c, 1.5f)).epsilon(1e-4));
        CHECK(fresnel_conductor(c, 1 / 1.5f, 0.f)[1] == doctest::Approx(fresnel_dielectric(c, 1 / 1.5f)).epsilon(2e-3));
    }
    CHECK(fresnel_conductor(0, kEta, kExtinction).min() == 1);
}

TEST_CASE("a rough metal reflects the integral of Fresnel x GGX") {
    const Vec3f n{0, 0, 1};
    for (const float alpha : {0.1f, 0.4f, 0.9f}) {
        const MetalBsdf metal{n, n, {1.f, true, kEta, kExtinction}, {n, {1, 0, 0}, alpha, alpha}};
        for (const float z : {0.95f, 0.6f, 0.3f}) {
            const Vec3f wo{std::sqrt(1 - z * z), 0, z};
            // Reference in double, integrated over half vectors: D G2 F / (4 cos_o cos_i) cos_i dw.
            double sum[kWavelengths] = {};
            constexpr int kRings = 600, kTurns = 200;
            for (int i = 0; i < kRings; ++i) {
                const double theta = 0.5 * kPiD * (i + 0.5) / kRings, st = std::sin(theta), ct = std::cos(theta);
                for (int j = 0; j < kTurns; ++j) {
                    const double phi = kPiD * (j + 0.5) / kTurns;   // half a circle; the other half is symmetric
                    const Vec3d h{st * std::cos(phi), st * std::sin(phi), ct}, o = to_double(wo);
                    const double oh = dot(o, h);
                    const Vec3d i_dir = h * (2 * oh) - o;
                    if (oh <= 0 || i_dir.z <= 0) continue;
                    const double a2 = double(alpha) * alpha, t = (st * st) / (a2 * ct * ct) + 1;
                    const double d = 1 / (kPiD * a2 * ct * ct * ct * ct * t * t);
                    const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1); };
                    const double g2 = 1 / (1 + lambda(o.z) + lambda(i_dir.z));
                    const double area = 2 * st * (0.5 * kPiD / kRings) * (kPiD / kTurns);
                    const double f = d * g2 / (4 * o.z) * 4 * oh * area;   // dw_i = 4 (o.h) dw_h
                    for (int k = 0; k < kWavelengths; ++k) sum[k] += f * by_amplitudes(oh, {kEta[k], kExtinction[k]});
                }
            }
            const check::Albedo a = check::albedo_by_sampling(metal, {Frame::from_normal(n), wo, 1}, 40000, 3);
            for (int k = 0; k < kWavelengths; ++k) {
                CHECK(std::abs(a.value[k] - sum[k]) < 4.5 * a.error[k] + 1e-3 * sum[k]);
                CHECK(std::abs(a.value[k] - 0.97 * sum[k]) > 4.5 * a.error[k]);   // detects an error of 3 %
            }
        }
    }
}

}  // namespace dg
