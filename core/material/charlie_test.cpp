// charlie_test.cpp -- the sheen against the formulas of KHR_materials_sheen, in double.
#include "material/charlie.h"

#include <doctest/doctest.h>

#include "material/baked.h"
#include "material/bsdf_layered.h"

namespace dg {
namespace {

/// l() and lambdaSheen() of the extension's text.
double l(double x, double alpha) {
    const double t = (1 - alpha) * (1 - alpha);
    const double a = 21.5473 * (1 - t) + 25.3245 * t, b = 3.82987 * (1 - t) + 3.32435 * t;
    const double c = 0.19823 * (1 - t) + 0.16801 * t, d = -1.97760 * (1 - t) - 1.27393 * t;
    const double e = -4.32054 * (1 - t) - 4.85967 * t;
    return a / (1 + b * std::pow(x, c)) + d * x + e;
}
double lambda(double c, double alpha) {
    return c < 0.5 ? std::exp(l(c, alpha))
                   : std::exp(2 * l(0.5, alpha) - l(1 - c, alpha));
}

/// f of white sheen.
double khronos(Vec3d wo, Vec3d wi, double roughness) {
    const double alpha = roughness * roughness;
    const Vec3d h = normalize(wo + wi);
    const double d = (2 + 1 / alpha) * std::pow(1 - h.z * h.z, 0.5 / alpha) / (2 * kPiD);
    return d / ((1 + lambda(wo.z, alpha) + lambda(wi.z, alpha)) * 4 * wo.z * wi.z);
}

Vec3d direction(double cos_angle, double phi) {
    const double r = std::sqrt(1 - cos_angle * cos_angle);
    return {r * std::cos(phi), r * std::sin(phi), cos_angle};
}

double albedo(double cos_o, double roughness) {
    constexpr int kRings = 300, kTurns = 100;
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const double x = (i + 0.5) / kRings, c = x * x;
        for (int j = 0; j < kTurns; ++j)
            sum += khronos(direction(cos_o, 0), direction(c, kPiD * (j + 0.5) / kTurns),
                           roughness) *
                   c * 2 * x;
    }
    return sum * 2 * kPiD / (kRings * kTurns);
}

}  // namespace

TEST_CASE("sheen is colour x D x V of the extension") {
    for (float roughness : {0.15f, 0.4f, 1.f}) {
        const Sheen sheen({0.2f, 0.4f, 0.8f, 1}, 1, roughness);
        for (double cos_o : {0.3, 0.8, 1.0}) {
            for (double cos_i : {0.25, 0.45, 0.9}) {
                const Vec3d wo = direction(cos_o, 0), wi = direction(cos_i, 2.1);
                const Spectrum f =
                    sheen.evaluate({0, 0, 1}, to_float(wo), to_float(wi),
                                   static_cast<float>(cos_o), static_cast<float>(cos_i));
                const double wanted = khronos(wo, wi, roughness) * cos_i;
                CHECK(f[3] == doctest::Approx(wanted).epsilon(1e-3));
                CHECK(f[0] == doctest::Approx(0.2 * wanted).epsilon(1e-3));
            }
        }
    }
}

TEST_CASE("the table is the albedo, between the nodes too") {
    for (float roughness : {0.1f, 0.23f, 0.5f, 0.77f, 1.f}) {
        const CharlieAlbedo::Row row = baked::charlie.row(roughness);
        for (float c : {0.1f, 0.22f, 0.5f, 0.81f, 1.f}) {
            CAPTURE(roughness);
            CAPTURE(c);
            CHECK(std::abs(row.at(c) - albedo(c, roughness)) < 0.012);
        }
    }
}

TEST_CASE("the base keeps min(1 - m E(wo), 1 - m E(wi))") {
    const Sheen sheen(0.5f, 0.5f, 0.6f);
    const double eo = albedo(0.3, 0.6), ei = albedo(0.7, 0.6);
    CHECK(sheen.passed(0.3f, 0.7f) ==
          doctest::Approx(std::min(1 - 0.5 * eo, 1 - 0.5 * ei)).epsilon(0.01));
    CHECK(sheen.passed(0.3f, 0.7f) == sheen.passed(0.7f, 0.3f));
    CHECK(Sheen(1.f, 1, 0.07f).passed(0.01f, 0.5f) == 0);  // E is limited to 1
}

}  // namespace dg
