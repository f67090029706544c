// glass_albedo_test.cpp -- mean Fresnel reflectance, the tables, and energy conservation of glass.
#include "material/glass_albedo.h"

#include <doctest/doctest.h>

#include "material/bsdf_check.h"
#include "material/bsdf_glass.h"

namespace dg {
namespace {

const Vec3f kUp{0, 0, 1};

Vec3f at_cosine(float z) { return {std::sqrt(1 - z * z), 0, z}; }

double mean_by_quadrature(double eta) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps;
        sum += 2 * c * fresnel_dielectric(static_cast<float>(c), static_cast<float>(eta)) / kSteps;
    }
    return sum;
}

GlassBsdf rough(float ior, float alpha, bool compensated, bool thin = false) {
    GlassBsdf g{kUp, kUp, 1.f, 1.f, ior, thin};
    g.iors = ior;
    g.facets = {kUp, {1, 0, 0}, alpha, alpha};
    if (compensated) g.compensation.emplace(std::max(ior, 1 / ior), g.facets);
    return g;
}

double energy(const GlassBsdf& g, float z) {
    const check::Setting s{Frame::from_normal(kUp), at_cosine(z), g.thin ? 1 : z > 0 ? g.ior : 1 / g.ior};
    return check::albedo_by_sampling(g, s, 60000, 5).value[0];
}

}  // namespace

TEST_CASE("the mean of Fresnel's reflectance, in closed form and by quadrature, from both sides") {
    for (const float n : {1.005f, 1.02f, 1.2f, 1.33f, 1.5f, 2.f, 4.f, 9.f}) {
        CAPTURE(n);
        CHECK(mean_fresnel(n) == doctest::Approx(mean_by_quadrature(n)).epsilon(n < 1.1f ? 0.05 : 1e-3));
        CHECK(1 - (1 - mean_fresnel(n)) / (n * n) == doctest::Approx(mean_by_quadrature(1 / n)).epsilon(5e-3));
    }
    CHECK(mean_fresnel(1) == 0);
}

TEST_CASE("the tables are what glass of one bounce returns") {
    for (const float n : {1.33f, 1.5f, 2.2f}) {
        for (const float alpha : {0.1f, 0.35f, 0.8f}) {
            const GlassAlbedo table(n, {kUp, {1, 0, 0}, alpha, alpha});
            for (const float z : {0.95f, 0.5f, 0.15f}) {
                CAPTURE(n);
                CAPTURE(alpha);
                CAPTURE(z);
                const GlassLobes lobes = table.toward(at_cosine(z), z);
                CHECK(1 - lobes.missing_thin == doctest::Approx(energy(rough(n, alpha, false), z)).epsilon(0.01));
                CHECK(1 - lobes.missing_dense == doctest::Approx(energy(rough(n, alpha, false), -z)).epsilon(0.01));
            }
        }
    }
}

TEST_CASE("rough glass that keeps its energy returns all light, from either side; without it is dark") {
    for (const float n : {1.5f, 0.75f, 2.2f}) {
        for (const float alpha : {0.05f, 0.3f, 0.6f, 1.f}) {
            for (const float z : {0.95f, 0.4f, 0.15f, -0.9f, -0.3f}) {
                CAPTURE(n);
                CAPTURE(alpha);
                CAPTURE(z);
                CHECK(energy(rough(n, alpha, true), z) == doctest::Approx(1).epsilon(0.01));
                CHECK(energy(rough(n, alpha, true, true), z) == doctest::Approx(1).epsilon(0.01));
            }
        }
    }
    CHECK(energy(rough(1.5f, 0.8f, false), 0.3f) < 0.95);
    CHECK(energy(rough(1.5f, 0.8f, false, true), 0.3f) < 0.95);
}

TEST_CASE("a pane reflects 2 F / (1 + F), and loses nothing") {
    GlassBsdf pane = rough(1.5f, 0, false, true);
    const double f = fresnel_dielectric(0.6f, 1.5f);
    double series = f, inside = (1 - f) * (1 - f) * f;   // sum over bounces
    for (int i = 0; i < 50; ++i, inside *= f * f) series += inside;
    const auto r = pane.sample(at_cosine(0.6f), 0, {0.5f, 0.5f});
    REQUIRE(r);
    CHECK(r->pdf * r->weight[1] == doctest::Approx(series).epsilon(1e-5));
    CHECK(pane.straight_transmittance(at_cosine(0.6f))[2] == doctest::Approx(1 - series).epsilon(1e-5));
    const auto t = pane.sample(at_cosine(0.6f), 0.9f, {0.5f, 0.5f});
    REQUIRE(t);
    CHECK(t->transmitted);
    CHECK(length(t->wi + at_cosine(0.6f)) < 1e-6f);
    CHECK_FALSE(pane.bounds_volume());
}

}  // namespace dg
