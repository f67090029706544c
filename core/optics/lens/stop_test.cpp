#include "optics/lens/stop.h"

#include <doctest/doctest.h>

#include <random>

#include "math/error.h"
#include "math/statistics.h"

using namespace dg;

namespace {

std::vector<float> heart(int size) {
    std::vector<float> v(std::size_t(size) * size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double a = 2.6 * ((x + 0.5) / size - 0.5),
                         b = -2.6 * ((y + 0.5) / size - 0.5);
            const double q = a * a + b * b - 1;
            v[y * size + x] = q * q * q - a * a * b * b * b <= 0 ? 1.f : 0.f;
        }
    return v;
}

std::vector<Iris> shapes() {
    return {Iris(),
            Iris::polygon(3, 0, 0),
            Iris::polygon(5, 17, 0),
            Iris::polygon(6, 0, 0.5),
            Iris::polygon(7, 40, 1),
            Iris::polygon(9, 10, -0.6),
            Iris::polygon(4, 0, -1),
            Iris::image(64, 64, heart(64))};
}

/// p-value of a chi-square test that samples are uniform over the shape's sampling region. `skew`
/// plants a fault: it is the fraction of samples drawn with u.x squeezed to its lower half.
double evenness(const Iris& iris, double enlargement, double skew) {
    constexpr int kCells = 14, kSamples = 500000, kFine = 50;
    const double r = 1.0001 * enlargement * iris.outer_radius(), cell = 2 * r / kCells;
    std::vector<double> seen(kCells * kCells), expected(kCells * kCells);
    double total = 0;
    for (int i = 0; i < kCells * kCells * kFine * kFine; ++i) {
        const int c = i / (kFine * kFine), f = i % (kFine * kFine);
        const Vec2d p{-r + cell * (c % kCells + (f % kFine + 0.5) / kFine),
                      -r + cell * (c / kCells + (f / kFine + 0.5) / kFine)};
        if (iris.in_sampling_region(p, enlargement)) expected[c] += 1, total += 1;
    }
    // Area of the region by counting cells of a fine grid.
    CHECK(total * cell * cell / (kFine * kFine) ==
          doctest::Approx(iris.sampling_area(enlargement)).epsilon(3e-3));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(0, 1);
    for (int i = 0; i < kSamples; ++i) {
        Vec2d v{u(random), u(random)};
        if (u(random) < skew) v.x *= 0.5;
        const Vec2d p = iris.sample(v, enlargement);
        if (!iris.in_sampling_region(p * (1 - 1e-9), enlargement)) return 0;
        const int x = int((p.x + r) / cell), y = int((p.y + r) / cell);
        seen[y * kCells + x] += 1;
    }
    for (double& e : expected) e *= kSamples / total;
    // Cells on the boundary have areas known only to the fine grid's accuracy; the test merges them
    // into one cell.
    double rest_seen = 0, rest_expected = 0;
    for (int c = 0; c < kCells * kCells; ++c) {
        const double full = double(kSamples) * kFine * kFine / total;
        if (expected[c] > 0.999 * full) continue;
        rest_seen += seen[c], rest_expected += expected[c];
        seen[c] = expected[c] = 0;
    }
    seen.push_back(rest_seen), expected.push_back(rest_expected);
    std::vector<double> s, e;
    for (std::size_t c = 0; c < seen.size(); ++c)
        if (expected[c] > 0) s.push_back(seen[c]), e.push_back(expected[c]);
    return chi_square_test(s, e).p_value;
}

}  // namespace

TEST_CASE("every shape has the area of the unit circle") {
    for (const Iris& iris : shapes()) {
        const double r = iris.outer_radius();
        constexpr int kGrid = 1200;
        double sum = 0;
        for (int y = 0; y < kGrid; ++y)
            for (int x = 0; x < kGrid; ++x)
                sum += iris.transmission(
                    {r * (2 * (x + 0.5) / kGrid - 1), r * (2 * (y + 0.5) / kGrid - 1)});
        CHECK(sum * 4 * r * r / (kGrid * kGrid) == doctest::Approx(kPiD).epsilon(2e-3));
    }
}

TEST_CASE("iris points fall evenly; a 2 % fault is caught") {
    const auto all = shapes();
    const double level = sidak_level(1e-3, 2.0 * all.size());
    for (const Iris& iris : all)
        for (const double enlargement : {1.0, 1.01})
            CHECK(evenness(iris, enlargement, 0) > level);
    CHECK(evenness(Iris(), 1, 0.02) < level);
    CHECK(evenness(Iris::polygon(7, 0, 0.5), 1, 0.02) < level);
}

TEST_CASE("the sampling region covers the shape, also 1 % off") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    for (const Iris& iris : shapes())
        for (int i = 0; i < 20000; ++i) {
            const Vec2d p = iris.outer_radius() * Vec2d{u(random), u(random)};
            if (iris.transmission(p) > 0) {
                CHECK(iris.in_sampling_region(p, 1));
                CHECK(iris.in_sampling_region(p, 1.01));
            }
        }
}

TEST_CASE(
    "curvature 1 is the circle; a regular polygon has its corners where rotation says") {
    const Iris round = Iris::polygon(6, 0, 1);
    for (double phi = 0; phi < 6.28; phi += 0.01) {
        CHECK(round.transmission({0.999 * std::cos(phi), 0.999 * std::sin(phi)}) == 1);
        CHECK(round.transmission({1.001 * std::cos(phi), 1.001 * std::sin(phi)}) == 0);
    }
    const Iris square = Iris::polygon(4, 30, 0);
    const double corner = std::sqrt(kPiD / 2);
    const Vec2d axis{std::cos(kPiD / 6), std::sin(kPiD / 6)};
    CHECK(square.transmission(0.999 * corner * axis) == 1);
    CHECK(square.transmission(1.001 * corner * axis) == 0);
}

TEST_CASE("an image: first row at the top, grey lets part through") {
    const Iris iris = Iris::image(2, 2, {1, 0, 0, 0.5f});
    CHECK(iris.transmission({-0.5, 0.5}) == 1);
    CHECK(iris.transmission({0.5, 0.5}) == 0);
    CHECK(iris.transmission({0.5, -0.5}) == 0.5);
}

TEST_CASE("impossible irises are refused") {
    CHECK_THROWS_AS(Iris::polygon(2, 0, 0), Error);
    CHECK_THROWS_AS(Iris::polygon(6, 0, 2), Error);
    CHECK_THROWS_AS(Iris::polygon(6, std::nan(""), 0), Error);
    CHECK_THROWS_AS(Iris::image(2, 2, {0, 0, 0, 0}), Error);
    CHECK_THROWS_AS(Iris::image(2, 2, {0, 0, 0}), Error);
    CHECK_THROWS_AS(Iris::image(1, 1, {std::nanf("")}), Error);
}
