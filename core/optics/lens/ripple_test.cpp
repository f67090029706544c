// Ripple: height and band of the profile, and equal normals in both tracers.
#include "optics/lens/ripple.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "math/vec.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/trace_simd.h"

namespace dg {
namespace {

Prescription rippled(double rms_nm) {
    Prescription lens = test::tessar();
    lens.surfaces[0].ripple = {rms_nm, 200, 5};
    return lens;
}

}  // namespace

TEST_CASE("grooves have the height and the period that are asked for") {
    const RippleSlope r({30, 100, 7}, 20);
    double height = 0, mean = 0, squares = 0, crossings = 0, before = 0;
    constexpr int kSteps = 200000;
    const double step = 19.9 / kSteps;
    std::vector<double> heights;
    for (int i = 0; i < kSteps; ++i) {
        const double slope = r.at((i + 0.5) * step);
        height += slope * step, mean += height / kSteps;
        heights.push_back(height);
        crossings += slope * before < 0;
        before = slope;
    }
    for (const double h : heights) squares += (h - mean) * (h - mean) / kSteps;
    CHECK(std::abs(std::sqrt(squares) / 30e-6 - 1) < 0.1);   // doctest::Approx adds 1 to its scale, hence the
                                                             // explicit bound
    CHECK(std::abs(19.9 / (crossings / 2) / 0.1 - 1) < 0.15);   // mm per wave
    CHECK(r.at(3.3) == RippleSlope({30, 100, 7}, 20).at(3.3));
    CHECK(r.at(3.3) != RippleSlope({30, 100, 8}, 20).at(3.3));
    CHECK(RippleSlope({0, 100, 7}, 20).slope.empty());
}

TEST_CASE("a ray leans by (n - 1) times the slope, the same in double and in lanes") {
    const Tracer plain(rippled(0)), rough(rippled(50));
    const LensIndices n = plain.at(550);
    const RippleSlope slope({50, 200, 5}, clear_radius(rippled(50).surfaces[0]));
    double largest = 0, worst = 0;
    auto scene = std::make_unique<SceneRays>();
    auto film = std::make_unique<FilmRays>();
    const LensTables tables = make_lens_tables(rough, 60, true, nullptr, 0);
    for (int i = 0; i < kLensBatch; ++i) {
        scene->x[i] = 0.05f * float(i % 64), scene->y[i] = 0.03f * float(i / 64);
        scene->z[i] = -1, scene->dx[i] = scene->dy[i] = 0, scene->dz[i] = -1;   // points to the scene
        film->nm[i] = 550;
    }
    trace_to_film(tables, *scene, *film, kLensBatch);
    for (int i = 0; i < kLensBatch; i += 7) {
        const LensRay ray{{0.05 * double(i % 64), 0.03 * double(i / 64), -1}, {0, 0, 1}};
        const auto a = plain.to_film(ray, n, {true, nullptr, 0});
        const auto b = rough.to_film(ray, n, {true, nullptr, 0});
        if (!a || !b) continue;
        const Vec3d p = at_plane(b->ray, 60), q = at_plane(a->ray, 60);
        largest = std::max(largest, length(p - q));
        worst = std::max(worst, std::hypot(p.x - film->x[i], p.y - film->y[i]));
    }
    CHECK(largest > 2e-3);   // mm: the ripple displaces rays measurably
    CHECK(worst < 0.05 * largest);
}

}  // namespace dg
