#include "optics/stray/finish.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "math/error.h"
#include "math/statistics.h"

using namespace dg;

namespace {

const Finish kFinishes[] = {{}, {.diffuse = 0.2, .gloss = 0.02, .lobe = {0.3, -2}}, {.diffuse = 0, .gloss = 0.03}};

Vec3d direction(double cosine, double phi) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

}  // namespace

TEST_CASE("a finish is the same when light goes the other way") {
    for (const Finish& f : kFinishes) {
        const FinishScatter scatter(f, "barrel");
        const Vec3d a = direction(0.15, 0.2), b = direction(0.7, 2.9);
        CHECK(scatter.value(a, b) > 0);
        CHECK(scatter.value(a, b) == doctest::Approx(scatter.value(b, a)).epsilon(1e-12));
        CHECK(scatter.value(a, {b.x, b.y, -b.z}) == 0);
    }
}

TEST_CASE("what a finish sends back is the integral of its values") {
    for (const Finish& f : kFinishes)
        for (const double cosine : {0.05, 0.3, 1.0}) {
            const FinishScatter scatter(f, "barrel");
            const Vec3d in = direction(cosine, 0);
            double sum = 0;
            constexpr int kN = 700;   // steps of the projected hemisphere, by radius squared and by angle
            for (int i = 0; i < kN; ++i)
                for (int j = 0; j < kN; ++j) {
                    const double r2 = (i + 0.5) / kN;
                    sum += scatter.value(in, direction(std::sqrt(1 - r2), 2 * kPiD * (j + 0.5) / kN));
                }
            INFO("cosine " << cosine);
            CHECK(kPiD * sum / (kN * kN) == doctest::Approx(scatter.albedo(cosine)).epsilon(2e-3));
        }
}

TEST_CASE("directions of a finish are drawn from the density that is said") {
    std::mt19937_64 rng(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const Finish& f : kFinishes) {
        const FinishScatter scatter(f, "barrel");
        const Vec3d in = direction(0.4, 0.7);
        constexpr int kCells = 10, kDraws = 40000, kFine = 30;
        std::vector<double> seen(kCells * kCells), wanted(kCells * kCells);
        for (int i = 0; i < kDraws; ++i) {   // cells of cos^2 and azimuth
            const Vec3d d = scatter.sample(in, uniform(rng), {uniform(rng), uniform(rng)});
            const double phi = (std::atan2(d.y, d.x) + kPiD) / (2 * kPiD);
            seen[std::min(int(d.z * d.z * kCells), kCells - 1) * kCells + std::min(int(phi * kCells), kCells - 1)] += 1;
        }
        double all = 0;
        for (int j = 0; j < kCells * kFine; ++j)
            for (int i = 0; i < kCells * kFine; ++i) {
                const double c = std::sqrt((j + 0.5) / (kCells * kFine));
                const Vec3d d = direction(c, 2 * kPiD * (i + 0.5) / (kCells * kFine) - kPiD);
                // d(omega) = d(cos) d(phi) = d(cos^2) d(phi) / (2 cos)
                const double p = scatter.pdf(in, d) / (2 * c) * 2 * kPiD / (kCells * kFine * kCells * kFine);
                wanted[(j / kFine) * kCells + i / kFine] += kDraws * p;
                all += p;
            }
        CHECK(all == doctest::Approx(1).epsilon(3e-3));
        CHECK(chi_square_test(seen, wanted).p_value > 1e-3);
    }
}

TEST_CASE("black paint is black, and shines when light grazes it") {
    const FinishScatter paint(Finish{}, "barrel");
    CHECK(paint.albedo(1) == doctest::Approx(0.035).epsilon(0.02));
    CHECK(paint.albedo(0.05) - 0.03 > 2 * (paint.albedo(1) - 0.03));
    CHECK(paint.value(direction(0.05, 0), direction(0.05, kPiD)) > 10 * paint.value({0, 0, 1}, {0, 0, 1}));
    double all = 0;   // albedo under uniform illumination: 3 to 5 % (Z306)
    for (int i = 0; i < 1000; ++i) all += paint.albedo(std::sqrt((i + 0.5) / 1000)) / 1000;
    CHECK(all > 0.03);
    CHECK(all < 0.05);
}

TEST_CASE("a finish that sends back more than arrives is refused") {
    CHECK_THROWS_WITH_AS(FinishScatter({.diffuse = 1.2}, "barrel"), doctest::Contains("barrel, diffuse"), Error);
    CHECK_THROWS_WITH_AS(FinishScatter({.diffuse = 0.9, .gloss = 0.1}, "blades"),
                         doctest::Contains("at most all light"), Error);
    CHECK(FinishScatter({.diffuse = 1, .gloss = 0}, "barrel").albedo(0.3) == doctest::Approx(1));
}
