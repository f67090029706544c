// beckmann_test.cpp -- the error function, and Beckmann's distribution against its integrals.
#include "material/beckmann.h"

#include <doctest/doctest.h>

#include "material/bsdf_check.h"
#include "material/facets.h"

namespace dg {
namespace {

const Vec3f kUp{0, 0, 1};

StretchedBeckmann stretched(float alpha_t, float alpha_b) { return {{0.6f, 0.8f, 0}, {-0.8f, 0.6f, 0}, alpha_t, alpha_b}; }

/// Midpoint rule over slopes up to five times alpha: calls the function with h and its solid angle.
template <typename What>
void for_facets(const StretchedBeckmann& b, What what) {
    constexpr int kSteps = 400;
    constexpr double kCell = 10.0 / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double t = b.alpha_t * ((i + 0.5) * kCell - 5), s = b.alpha_b * ((j + 0.5) * kCell - 5);
            const double cosine = 1 / std::sqrt(1 + t * t + s * s);
            const Vec3d h = (to_double(b.tangent) * t + to_double(b.bitangent) * s + Vec3d{0, 0, 1}) * cosine;
            what(h, b.alpha_t * b.alpha_b * kCell * kCell * cosine * cosine * cosine);
        }
    }
}

}  // namespace

TEST_CASE("the error function and its inverse") {
    for (int i = -400; i <= 400; ++i) {
        const float x = static_cast<float>(i) / 100;
        CHECK(std::abs(error_function(x, std::exp(-x * x)) - std::erf(x)) < 3e-7f);
        if (std::abs(x) < 3) CHECK(std::erf(inverse_error_function(std::erf(x))) == doctest::Approx(std::erf(x)).epsilon(1e-6));
    }
    CHECK(inverse_error_function(0.5f) == doctest::Approx(0.476936276).epsilon(1e-6));
    CHECK(std::isfinite(inverse_error_function(1)));
}

TEST_CASE("Beckmann: the facets cover the surface, and a direction sees as much of them as its mask says") {
    for (const auto& [u, v] : {Vec2f{0.01f, 0.01f}, {0.3f, 0.3f}, {0.1f, 0.7f}, {1, 0.4f}}) {
        CAPTURE(u);
        const StretchedBeckmann b = stretched(u, v);
        double covered = 0;
        for_facets(b, [&](Vec3d h, double cell) { covered += b.d(kUp, to_float(h), 1) * h.z * cell; });
        CHECK(covered == doctest::Approx(1).epsilon(2e-3));
        for (const float z : {1.f, 0.7f, 0.3f, 0.08f}) {
            CAPTURE(z);
            const float r = std::sqrt(1 - z * z);
            const Vec3f wo{r * 0.28f, r * 0.96f, z};
            double seen = 0;
            for_facets(b, [&](Vec3d h, double cell) {
                seen += std::max(0.0, dot(h, to_double(wo))) * b.d(kUp, to_float(h), 1) * cell;
            });
            // The facets' projection is cos / G1 = cos (1 + Lambda).
            CHECK(0.5 * (z + b.slope(wo, z)) == doctest::Approx(seen).epsilon(2e-3));
            if (u == v) CHECK(b.slope(wo, z) == doctest::Approx(beckmann_slope(u, z)).epsilon(1e-5));
        }
    }
}

TEST_CASE("Beckmann: visible normals are as frequent as they are seen") {
    const Frame frame{{0.6f, 0.8f, 0}, {-0.8f, 0.6f, 0}, kUp};
    check::Random random{5};
    for (const auto& [u, v] : {Vec2f{0.02f, 0.02f}, {0.4f, 0.4f}, {0.1f, 0.8f}}) {
        for (const float z : {1.f, 0.6f, 0.1f, 1e-3f}) {
            CAPTURE(u);
            CAPTURE(z);
            const StretchedBeckmann b = stretched(u, v);
            const float r = std::sqrt(1 - z * z);
            const Vec3f wo{r * 0.28f, r * 0.96f, z};
            // First and second moments of both slopes in units of alpha.
            double drawn[5] = {}, wanted[5] = {}, mass = 0;
            const auto add = [&](double* sum, Vec3d h, double weight) {
                const double t = dot(to_double(b.tangent), h) / (h.z * u), s = dot(to_double(b.bitangent), h) / (h.z * v);
                sum[0] += t * weight, sum[1] += s * weight, sum[2] += t * t * weight, sum[3] += s * s * weight;
                sum[4] += t * s * weight;
            };
            constexpr int kCount = 200000;
            for (int i = 0; i < kCount; ++i)
                add(drawn, to_double(sample_visible_beckmann(frame, wo, {u, v}, random.next_2d())), 1.0 / kCount);
            for_facets(b, [&](Vec3d h, double cell) {
                const double seen = std::max(0.0, dot(h, to_double(wo))) * b.d(kUp, to_float(h), 1) * cell;
                add(wanted, h, seen);
                mass += seen;
            });
            for (int k = 0; k < 5; ++k) CHECK(std::abs(drawn[k] - wanted[k] / mass) < 0.012);
        }
    }
}

TEST_CASE("Beckmann: white furnace of facets that nothing shadows") {
    // The density of reflected directions, f of G1 alone, integrates to 1 over the sphere (Heitz 2014, eq. 114).
    for (const float alpha : {0.2f, 0.6f}) {
        const Facets facets(kUp, {1, 0, 0}, alpha, alpha, Distribution::beckmann);
        for (const float z : {0.9f, 0.4f}) {
            const Vec3f wo{std::sqrt(1 - z * z), 0, z};
            constexpr int kRows = 600, kColumns = 1200;
            double sum = 0;
            for (int i = 0; i < kRows; ++i) {
                const double theta = kPiD * (i + 0.5) / kRows;
                const double cell = kPiD / kRows * 2 * kPiD / kColumns * std::sin(theta);
                for (int j = 0; j < kColumns; ++j) {
                    const Vec3f wi = check::grid_direction({{1, 0, 0}, {0, 1, 0}, kUp}, theta,
                                                           2 * kPiD * (j + 0.5) / kColumns);
                    if (dot(wo + wi, kUp) > 0) sum += facets.reflecting(kUp, wo, wi, z, wi.z).pdf * cell;
                }
            }
            CHECK(sum == doctest::Approx(1).epsilon(2e-3));
        }
    }
}

TEST_CASE("Beckmann: glancing and extreme directions give finite numbers") {
    check::Random random{9};
    const Facets sharp(kUp, {1, 0, 0}, kSmoothAlpha, 0.5f, Distribution::beckmann);
    for (int i = 0; i < 20000; ++i) {
        Vec3f wo = random.direction();
        wo.z = std::abs(wo.z) * (i % 2 ? 1e-5f : 1);
        wo = normalize(wo);
        const Vec3f h = sharp.sample_visible(kUp, wo, i % 3 ? random.next_2d() : Vec2f{0, 1});
        CHECK(std::abs(length(h) - 1) < 1e-5f);
        const Vec3f wi = reflect(wo, h);
        if (wi.z <= 0 || wo.z <= 0) continue;
        const Facet f = sharp.reflecting(kUp, wo, wi, wo.z, wi.z);
        CHECK(std::isfinite(f.pdf));
        CHECK(std::isfinite(f.f_cos));
    }
}

}  // namespace dg
