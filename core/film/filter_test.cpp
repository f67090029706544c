// filter_test.cpp -- every filter: samples against values, weights, shape, and a planted
// fault.
#include "film/filter.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/error.h"
#include "math/hash.h"
#include "math/statistics.h"

using namespace dg;

namespace {

constexpr FilterKind kKinds[] = {FilterKind::box, FilterKind::gaussian,
                                 FilterKind::blackman_harris, FilterKind::mitchell,
                                 FilterKind::tent};
constexpr int kCells = 16, kSub = 32, kSamples = 300000;

struct Tally {
    std::vector<double> count, expected, signed_weight, integral;
};

/// Compares samples per cell with the integral of |evaluate|, and signed weights with the integral of evaluate.
Tally tally(const Filter& filter, double fault) {
    const double r = filter.radius(), cell = 2 * r / kCells;
    Tally t{std::vector<double>(kCells * kCells),
            {},
            std::vector<double>(kCells * kCells),
            {}};
    t.expected = t.integral = t.count;
    for (int i = 0; i < kSamples; ++i) {
        const FilterSample s = filter.sample({float(hash_uniform(1, i)) * 0.9999999f,
                                              float(hash_uniform(2, i)) * 0.9999999f});
        const int x = std::clamp(int((s.offset.x + r) / cell), 0, kCells - 1);
        const int y = std::clamp(int((s.offset.y + r) / cell), 0, kCells - 1);
        ++t.count[y * kCells + x];
        t.signed_weight[y * kCells + x] += double(s.weight) / kSamples;
    }
    const double dab = cell * cell / (kSub * kSub);
    for (int j = 0; j < kCells * kSub; ++j)
        for (int i = 0; i < kCells * kSub; ++i) {
            const Vec2f p{float((i + 0.5) / kSub * cell - r),
                          float((j + 0.5) / kSub * cell - r)};
            const double v = filter.evaluate(p) * dab;
            const int c = (j / kSub) * kCells + i / kSub;
            t.integral[c] += v;
            t.expected[c] += std::abs(v) / filter.absolute_integral() * kSamples *
                             (p.x < 0 ? 1 - fault : 1 + fault);
        }
    return t;
}

double sum(const std::vector<double>& v) {
    double s = 0;
    for (const double x : v) s += x;
    return s;
}

}  // namespace

TEST_CASE("samples follow |f|, weights restore f, and f integrates to 1") {
    for (const FilterKind kind : kKinds)
        for (const float radius : {default_radius(kind), 3.7f}) {
            CAPTURE(int(kind));
            const Filter filter(kind, radius);
            const Tally t = tally(filter, 0);
            CHECK(chi_square_test(t.count, t.expected).p_value > 1e-4);
            CHECK(sum(t.integral) == doctest::Approx(1).epsilon(1e-5));
            CHECK(sum(t.signed_weight) == doctest::Approx(1).epsilon(0.01));
            for (std::size_t c = 0; c < t.integral.size(); ++c)
                CHECK(std::abs(t.signed_weight[c] - t.integral[c]) <
                      5 * std::sqrt(std::abs(t.integral[c]) * 1.5 / kSamples) + 2e-5);
        }
}

TEST_CASE("a 2 % fault is caught for every kind") {
    for (const FilterKind kind : kKinds) {
        const Tally t = tally(Filter(kind), 0.02);
        CHECK(chi_square_test(t.count, t.expected).p_value < 1e-3);
    }
}

TEST_CASE("shapes: printed values, symmetry, support") {
    // Mitchell at 0: (6 - 2B) / 6 = 8/9; its integral is 1 per axis.
    const Filter mitchell(FilterKind::mitchell);
    CHECK(mitchell.evaluate({0, 0}) == doctest::Approx(64.0 / 81).epsilon(1e-3));
    CHECK(mitchell.integral() == doctest::Approx(1).epsilon(1e-4));
    CHECK(mitchell.evaluate({1.5f, 0}) < 0);
    CHECK(mitchell.absolute_integral() > 1.05);
    // A box of radius 0.5 is the pixel.
    const Filter box(FilterKind::box);
    CHECK(box.evaluate({0.49f, -0.49f}) == 1);
    CHECK(box.evaluate({0.51f, 0}) == 0);
    CHECK(box.sample({0.3f, 0.9f}).weight == 1);
    // Blackman-Harris: mean of the window is its first coefficient.
    const Filter bh(FilterKind::blackman_harris, 1);
    CHECK(bh.integral() == doctest::Approx(4 * 0.35875 * 0.35875).epsilon(1e-4));
    const Filter gaussian(FilterKind::gaussian);
    CHECK(gaussian.evaluate({0.5f, 0}) / gaussian.evaluate({0, 0}) ==
          doctest::Approx((std::exp(-0.5) - std::exp(-4.5)) / (1 - std::exp(-4.5)))
              .epsilon(0.01));
    for (const FilterKind kind : kKinds) {
        const Filter f(kind);
        CHECK(f.evaluate({0.3f, -0.2f}) ==
              doctest::Approx(f.evaluate({-0.3f, 0.2f})).epsilon(0.02));
        CHECK(f.evaluate({f.radius() + 0.01f, 0}) == 0);
        CHECK(f.evaluate({0, std::nanf("")}) == 0);
        for (const float u : {0.f, 0x1.fffffep-1f}) {
            const FilterSample s = f.sample({u, u});
            CHECK(std::abs(s.offset.x) <= f.radius());
        }
    }
}

TEST_CASE("a tent: its height, its slope and its moments, in closed form") {
    for (const float r : {1.f, 2.f, 3.7f}) {
        const Filter tent(FilterKind::tent, r);
        CHECK(tent.integral() == doctest::Approx(double(r) * r).epsilon(1e-6));
        CHECK(tent.absolute_integral() == doctest::Approx(1).epsilon(1e-12));
        CHECK(tent.variance() == doctest::Approx(r * r / 6).epsilon(1e-4));
        double worst = 0, mean = 0, square = 0;
        for (int i = 0; i <= 1000; ++i) {
            const float x = (0.002f * float(i) - 1) * 0.9999f * r;
            worst = std::max(worst, std::abs(double(tent.axis(x)) * r - (1 - std::abs(x) / r)));
        }
        CHECK(worst < 1.0 / 256 + 1e-6);   // half a step of the table
        for (int i = 0; i < kSamples; ++i) {
            const FilterSample s = tent.sample({float(hash_uniform(3, i)) * 0.9999999f,
                                                float(hash_uniform(4, i)) * 0.9999999f});
            CHECK(s.weight == 1);
            mean += double(s.offset.x) / kSamples;
            square += double(s.offset.y) * s.offset.y / kSamples;
        }
        // Moments of a tent: r^2 / 6 and r^4 / 15, so the error of its square is r^2 sqrt(7/180).
        CHECK(std::abs(mean) < 4 * r * std::sqrt(1.0 / 6 / kSamples));
        CHECK(std::abs(square - r * r / 6) < 4 * r * r * std::sqrt(7.0 / 180 / kSamples));
    }
}

TEST_CASE("tents of one pixel add up to 1 wherever a sample lies") {
    const Filter tent(FilterKind::tent);
    for (int i = 0; i < 1000; ++i) {
        const float x = float(hash_uniform(5, i)), y = float(hash_uniform(6, i));
        double total = 0;
        for (const float dx : {0.f, 1.f})
            for (const float dy : {0.f, 1.f}) total += tent.evaluate({x - dx, y - dy});
        CHECK(total == doctest::Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("names and radii are checked") {
    CHECK(filter_kind("mitchell") == FilterKind::mitchell);
    CHECK(filter_kind("box") == FilterKind::box);
    CHECK(filter_kind("tent") == FilterKind::tent);
    CHECK_THROWS_WITH_AS(filter_kind("lanczos"), doctest::Contains("blackman_harris"),
                         Error);
    CHECK_THROWS_AS(Filter(FilterKind::box, 0), Error);
    CHECK_THROWS_AS(Filter(FilterKind::box, -1), Error);
    CHECK_THROWS_AS(Filter(FilterKind::box, std::nanf("")), Error);
    CHECK_THROWS_AS(Filter(FilterKind::box, 17), Error);
}
