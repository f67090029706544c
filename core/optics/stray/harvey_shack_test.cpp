#include "optics/stray/harvey_shack.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "math/error.h"
#include "math/statistics.h"

using namespace dg;

namespace {

const HarveyShack kLobes[] = {{0.01, -1.5}, {0.1, -2}, {0.3, -2.5}, {0.02, -3.5}};

/// Integral of the lobe by rings about its centre, each weighted by its part inside the disc;
/// independent of the class.
double by_rings(const HarveyShack& lobe, double offset, double n) {
    double sum = 0;
    constexpr int kRings = 400000;
    const double last = std::log1p((n + offset) / lobe.knee);
    for (int i = 0; i < kRings; ++i) {
        const double r = lobe.knee * std::expm1(last * (i + 0.5) / kRings);
        const double width = (r + lobe.knee) * last / kRings;
        const double cosine = (r * r + offset * offset - n * n) / (2 * r * offset);
        const double arc = cosine <= -1 ? 2 * kPiD : cosine >= 1 ? 0 : 2 * std::acos(cosine);
        sum += r * arc * std::pow(1 + r * r / (lobe.knee * lobe.knee), lobe.slope / 2) * width;
    }
    return sum;
}

}  // namespace

TEST_CASE("a lobe over all directions is what its rings hold") {
    for (const HarveyShack& lobe : kLobes)
        for (const double n : {1.0, 1.6})
            for (const double offset : {1e-9, 0.3, 0.49, 0.9, 0.98}) {
                INFO("knee " << lobe.knee << " slope " << lobe.slope << " n " << n << " offset " << offset);
                CHECK(lobe.over_directions(offset, n) ==
                      doctest::Approx(by_rings(lobe, offset, n)).epsilon(1e-4));
            }
}

TEST_CASE("directions are drawn from the density that is said") {
    std::mt19937_64 rng(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const HarveyShack& lobe : {kLobes[1], kLobes[2]}) {
        const Vec2d middle{0.5, -0.6};
        const double n = 1.2;
        constexpr int kCells = 12, kDraws = 40000, kFine = 24;
        std::vector<double> seen(kCells * kCells), wanted(kCells * kCells);
        const auto cell = [&](double x) { return std::min(int((x / n + 1) / 2 * kCells), kCells - 1); };
        for (int i = 0; i < kDraws; ++i) {
            const Vec2d b = lobe.sample(middle, n, {uniform(rng), uniform(rng)});
            REQUIRE(length(b) <= n * (1 + 1e-12));
            seen[cell(b.y) * kCells + cell(b.x)] += 1;
        }
        const double step = 2 * n / (kCells * kFine);
        double all = 0;
        for (int j = 0; j < kCells * kFine; ++j)
            for (int i = 0; i < kCells * kFine; ++i) {
                const double p = lobe.pdf(middle, n, {-n + (i + 0.5) * step, -n + (j + 0.5) * step}) * step * step;
                wanted[(j / kFine) * kCells + i / kFine] += kDraws * p;
                all += p;
            }
        CHECK(all == doctest::Approx(1).epsilon(3e-3));
        CHECK(chi_square_test(seen, wanted).p_value > 1e-3);
    }
}

TEST_CASE("shares of a lobe and the distances that hold them are inverse") {
    for (const HarveyShack& lobe : kLobes)
        for (const double u : {1e-6, 0.2, 0.9, 1.0})
            CHECK(lobe.within(lobe.radius(u, 1.3)) == doctest::Approx(u * lobe.within(1.3)).epsilon(1e-9));
}

TEST_CASE("total integrated scatter is that of Davies for mirrors, and less by (n - 1)^2 / 4 for glass") {
    // (4 pi 1 nm / 633 nm)^2 = 3.94e-4 for a mirror (Bennett and Mattsson 1999, Surface Roughness
    // and Scattering).
    CHECK(total_integrated_scatter(1, 2, 633) == doctest::Approx(3.94e-4).epsilon(2e-3));
    CHECK(total_integrated_scatter(1, 0.5, 633) == doctest::Approx(3.94e-4 / 16).epsilon(2e-3));
    CHECK(total_integrated_scatter(2, 2, 633) == doctest::Approx(4 * 3.94e-4).epsilon(2e-3));
    CHECK(total_integrated_scatter(1000, 2, 500) == doctest::Approx(1));   // ground glass: all light is scattered
}

TEST_CASE("lobes that cannot be are refused") {
    CHECK_THROWS_WITH_AS(check_lobe({0, -2}, "surface"), doctest::Contains("surface, knee: wanted"), Error);
    CHECK_THROWS_WITH_AS(check_lobe({0.1, 1}, "surface"), doctest::Contains("surface, slope: wanted"), Error);
}
