#include "medium/tracking.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/error.h"

namespace dg {
namespace {

using Size = DensityGrid::Size;

/// Random densities, many of them 0, in a rotated and stretched box.
DensityGrid uneven(Size size, int stream) {
    std::vector<float> values(std::size_t(size.x) * size.y * size.z);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double u = hash_uniform(stream, i);
        values[i] = u < 0.4 ? 0.f : float(3 * u * u);
    }
    const Affine3d box{{2, 0.5, 0}, {-0.4, 3, 0.2}, {0.1, 0, 1.5}, {-1, -1, 0.5}};
    return DensityGrid(size, values, box);
}

GridRay ray_through(const DensityGrid& grid, Vec3d from, Vec3d to) {
    const Affine3d& m = grid.unit_from_space();
    return {grid, m.point(from), m.vector(normalize(to - from))};
}

double optical_depth(const GridRay& ray, double begin, double end) {
    constexpr int kSteps = 200000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += double(ray.density(begin + (end - begin) * (i + 0.5) / kSteps));
    return sum * (end - begin) / kSteps;
}

const Vec3d kFrom{-3, -2, -1}, kTo{2, 2.5, 3};
const double kEnd = length(kTo - kFrom);

RayRandom numbers(int i) { return RayRandom({1, 2, 3}, {float(i), 0, 1}, 0.25f); }

}  // namespace

TEST_CASE("the blocks of a ray follow each other without gaps and hold every density between their bounds") {
    for (const Size size : {Size{1, 1, 1}, Size{9, 17, 8}, Size{40, 3, 25}}) {
        const DensityGrid grid = uneven(size, 3);
        for (int i = 0; i < 200; ++i) {
            const auto u = [&](int k) { return 6 * hash_uniform(20 + k, i) - 3; };
            const GridRay ray = ray_through(grid, {u(0), u(1), u(2)}, {u(3), u(4), u(5)});
            BlockTraversal walk(grid, ray.origin, ray.direction, 0, 8);
            double last = -1, inside = 0;
            while (const auto step = walk.next()) {
                if (last >= 0) CHECK(step->begin == last);
                last = step->end;
                inside += step->end - step->begin;
                for (const double share : {0.01, 0.5, 0.99}) {
                    const float d = ray.density(step->begin + share * (step->end - step->begin));
                    CHECK(d >= step->bounds.least * 0.9999f);
                    CHECK(d <= step->bounds.most * 1.0001f);
                }
            }
            double dense = 0;   // number of points inside the cube
            for (int k = 0; k < 4000; ++k) {
                const Vec3d p = ray.origin + ray.direction * (8 * (k + 0.5) / 4000);
                dense += p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1 && p.z >= 0 && p.z <= 1;
            }
            CHECK(std::abs(inside - dense * 8 / 4000) < 0.01);
        }
    }
}

TEST_CASE("ratio tracking finds exp(-optical depth) at every wavelength") {
    const DensityGrid grid = uneven({19, 12, 30}, 5);
    const GridRay ray = ray_through(grid, kFrom, kTo);
    const double depth = optical_depth(ray, 0, kEnd);
    const Spectrum extinction{0.2f, 1, 2.5f, 0};
    constexpr int kCount = 20000;
    double mean[4]{}, square[4]{};
    for (int i = 0; i < kCount; ++i) {
        const Spectrum left = ratio_tracking(ray, extinction, 0, kEnd, numbers(i));
        for (int k = 0; k < 4; ++k) {
            mean[k] += double(left[k]) / kCount, square[k] += double(left[k]) * left[k] / kCount;
            CHECK(left[k] >= 0);
            CHECK(left[k] <= 1);
        }
    }
    for (int k = 0; k < 4; ++k) {
        const double expected = std::exp(-depth * extinction[k]);
        const double error = std::sqrt((square[k] - mean[k] * mean[k]) / kCount);
        CHECK(std::abs(mean[k] - expected) < 4 * error + 1e-6);
        if (k < 3) CHECK(std::abs(mean[k] - expected * 0.9) > 4 * error);
    }
}

TEST_CASE("an even grid takes away what a homogeneous medium does, without noise") {
    const DensityGrid grid({5, 5, 5}, std::vector<float>(125, 0.5f), {});
    const GridRay ray = ray_through(grid, {0.5, 0.5, -1}, {0.5, 0.5, 2});
    CHECK(ratio_tracking(ray, 2.f, 0, 3, numbers(0))[0] == doctest::Approx(std::exp(-1.)));
    CHECK(ratio_tracking(ray, 2.f, 0, 1.5, numbers(0))[0] == doctest::Approx(std::exp(-0.5)));
}

TEST_CASE("delta tracking passes, scatters and shines with the right means at each wavelength") {
    const DensityGrid grid = uneven({19, 12, 30}, 6);
    const GridRay ray = ray_through(grid, kFrom, kTo);
    const double depth = optical_depth(ray, 0, kEnd);
    const MediumAt m{{0.1f, 0.8f, 2, 0.5f}, {0.2f, 1, 2.5f, 0.5f}, {1, 0.5f, 0.2f, 2}};
    for (const bool hero_only : {false, true}) {
        const Spectrum lanes = hero_only ? Spectrum(1.f) : Spectrum(1.6f, 0.4f, 0.5f, 1.5f);
        constexpr int kCount = 60000;
        double passed[4]{}, scattered[4]{}, emitted[4]{};
        for (int i = 0; i < kCount; ++i) {
            const Tracked t = delta_tracking(ray, m, lanes, hero_only, 0, kEnd, numbers(i));
            for (int k = 0; k < 4; ++k) {
                (t.collided ? scattered : passed)[k] += double(t.weight[k]) / kCount;
                emitted[k] += double(t.emitted[k]) / kCount;
            }
        }
        for (int k = 0; k < (hero_only ? 1 : 4); ++k) {
            const double left = std::exp(-depth * m.extinction[k]);
            CHECK(passed[k] == doctest::Approx(left).epsilon(0.02));
            CHECK(scattered[k] == doctest::Approx(m.scattering[k] / m.extinction[k] * (1 - left)).epsilon(0.02));
            CHECK(emitted[k] == doctest::Approx(m.emission[k] / m.extinction[k] * (1 - left)).epsilon(0.02));
        }
    }
}

TEST_CASE("grids that are none are refused") {
    CHECK_THROWS_AS(DensityGrid({2, 1, 1}, {1.f}, {}), Error);
    CHECK_THROWS_AS(DensityGrid({0, 1, 1}, {}, {}), Error);
    CHECK_THROWS_AS(DensityGrid({1, 1, 1}, {-1.f}, {}), Error);
    CHECK_THROWS_AS(DensityGrid({1, 1, 1}, {std::nanf("")}, {}), Error);
    CHECK_THROWS_AS(DensityGrid({1, 1, 1}, {1.f}, {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {}}), Error);
}

}  // namespace dg
