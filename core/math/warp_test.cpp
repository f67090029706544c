// warp_test.cpp -- warps against their densities, cell by cell; irises; planted faults.
#include "math/warp.h"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

#include "math/error.h"
#include "math/hash.h"
#include "math/statistics.h"

using namespace dg;

namespace {

constexpr int kCells = 16, kSamples = 300000;

/// Integral of pdf over a cell by n x n midpoints.
double cell_mass(const std::function<double(Vec2f)>& pdf, Vec2f corner, Vec2f size, int n,
                 bool& border) {
    double sum = 0;
    int empty = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double v = pdf(
                {corner.x + size.x * (i + 0.5f) / n, corner.y + size.y * (j + 0.5f) / n});
            empty += v <= 0;
            sum += v;
        }
    border = empty != 0 && empty != n * n;
    return sum * size.x * size.y / (n * n);
}

/// Integral of pdf over a cell, refined if a border crosses the cell.
double cell_mass(const std::function<double(Vec2f)>& pdf, Vec2f corner, Vec2f size) {
    bool border = false;
    const double mass = cell_mass(pdf, corner, size, 16, border);
    return border ? cell_mass(pdf, corner, size, 200, border) : mass;
}

/// Chi-square p-value of warp(u) against pdf on [low, high].
double warp_p_value(const std::function<Vec2f(Vec2f)>& warp,
                    const std::function<double(Vec2f)>& pdf, Vec2f low, Vec2f high,
                    std::uint64_t seed) {
    std::vector<double> observed(kCells * kCells), expected(kCells * kCells);
    const Vec2f size = high - low;
    int outside = 0;
    for (int i = 0; i < kSamples; ++i) {
        const Vec2f p = warp({float(hash_uniform(seed, i)) * 0.9999999f,
                              float(hash_uniform(seed + 1, i)) * 0.9999999f});
        outside += pdf(p) <= 0;
        const int x = std::clamp(int((p.x - low.x) / size.x * kCells), 0, kCells - 1);
        const int y = std::clamp(int((p.y - low.y) / size.y * kCells), 0, kCells - 1);
        ++observed[y * kCells + x];
    }
    double sum = 0;
    const Vec2f cell{size.x / kCells, size.y / kCells};
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
            const double mass =
                cell_mass(pdf, {low.x + i * cell.x, low.y + j * cell.y}, cell);
            expected[j * kCells + i] = mass * kSamples;
            sum += mass;
        }
    CHECK(sum == doctest::Approx(1).epsilon(1e-3));
    CHECK(outside < kSamples / 2000);  // rounding at a border only
    // Quadrature misses slivers at borders: give empty cells a small expectation, so that they are
    // pooled.
    for (double& e : expected) e += 1e-9;
    return chi_square_test(observed, expected, 0, 100).p_value;
}

}  // namespace

TEST_CASE("disc and triangle") {
    CHECK(warp_p_value(warp_disk, warp_disk_pdf, {-1, -1}, {1, 1}, 1) > 1e-4);
    CHECK(warp_p_value(warp_triangle, warp_triangle_pdf, {0, 0}, {1, 1}, 3) > 1e-4);
}

TEST_CASE("a 2 % fault in the density of the disc is caught") {
    const auto wrong = [](Vec2f p) { return warp_disk_pdf(p) * (p.x < 0 ? 0.98 : 1.02); };
    CHECK(warp_p_value(warp_disk, wrong, {-1, -1}, {1, 1}, 1) < 1e-3);
}

TEST_CASE("directions, seen as (cos theta, phi)") {
    // d omega = d cos theta d phi, so a density over directions is also a density over this
    // rectangle.
    const auto chart = [](Vec3f w) { return Vec2f{w.z, std::atan2(w.y, w.x)}; };
    const auto cosine = [&](Vec2f u) { return chart(warp_cosine_hemisphere(u)); };
    CHECK(warp_p_value(
              cosine,
              [](Vec2f c) {
                  return warp_cosine_hemisphere_pdf({0, 0, c.x});
              },
              {0, -kPi}, {1, kPi}, 5) > 1e-4);
    const auto sphere = [&](Vec2f u) { return chart(warp_sphere(u)); };
    CHECK(warp_p_value(
              sphere, [](Vec2f) { return warp_sphere_pdf(); }, {-1, -kPi}, {1, kPi}, 7) >
          1e-4);
    const float omc = 0.3f;
    const auto cone = [&](Vec2f u) { return chart(warp_cone(u, omc)); };
    CHECK(warp_p_value(
              cone, [&](Vec2f) { return warp_cone_pdf(omc); }, {1 - omc, -kPi}, {1, kPi},
              9) > 1e-4);
}

TEST_CASE("directions have unit length, also in a cone of a microradian") {
    for (int i = 0; i < 1000; ++i) {
        const Vec2f u{float(hash_uniform(1, i)), float(hash_uniform(2, i))};
        CHECK(length(warp_sphere(u)) == doctest::Approx(1).epsilon(1e-6));
        CHECK(length(warp_cosine_hemisphere(u)) == doctest::Approx(1).epsilon(1e-6));
        const Vec3f w = warp_cone(u, one_minus_cos_from_sin2(1e-12f));
        CHECK(length(Vec2f{w.x, w.y}) ==
              doctest::Approx(1e-6 * std::sqrt(u.x)).epsilon(1e-4));
    }
}
