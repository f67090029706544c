// ScatterBlur against ray matrices and against landing points of walks.
#include "optics/stray/scatter_blur.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"
#include "optics/stray/scatter_lens.h"

using namespace dg;

TEST_CASE("a lobe spreads light by the matrix of what follows, and two lobes by both") {
    const double a = 12, power = 0.03, b = 31, w = 0.02, second = 0.05;
    ScatterBlur one, both;
    one.scatter(w * w), both.scatter(w * w);
    one.travel(a), both.travel(a);
    one.bend(power), both.bend(power);
    both.scatter(second * second);
    one.travel(b), both.travel(b);
    const double first = a + b - a * b * power;
    CHECK(one.squared() == doctest::Approx(first * first * w * w));
    CHECK(both.squared() == doctest::Approx(first * first * w * w + b * b * second * second));
    ScatterBlur imaged;   // in the image of the scattering point
    imaged.scatter(1), imaged.travel(50), imaged.bend(1 / 25.0), imaged.travel(50);
    CHECK(imaged.squared() < 1e-6);
    ScatterBlur entered(9);   // parallel light, at the focus and 5 mm behind it
    entered.bend(1 / 25.0), entered.travel(25);
    CHECK(entered.squared() < 1e-6);
    entered.travel(5);
    CHECK(entered.squared() == doctest::Approx(9 / 25.0));
}

TEST_CASE("light that glass scatters lands as far from its image as its blur says") {
    const LensScatter rough{{.diffuse = 0, .gloss = 0}, {.diffuse = 0, .gloss = 0}, 1, {0.01, -1.5}};
    for (const Prescription& lens : {test::tessar(), test::telephoto()}) {
        const ScatterLens parts(lens, {{0, 0, first_order(lens).back_focal_z}}, Iris::polygon(6, 10, 0), 3, {}, 30, rough);
        const LensIndices n = parts.at(kDesignWavelength);
        std::vector<double> off;   // blur relative to the distance of the landing point
        std::mt19937_64 rng(5);
        for (int i = 0; i < 20000; ++i) {
            const auto light = parts.walk({{0.3, 0.2, 0}, {0, 0, 1}}, n, 1, rng(), {});
            if (!light || light->events != 1) continue;
            const double r = length(light->film), all = std::sqrt(std::max(light->blur2, 0.0));
            if (r > 3 || r < 0.3) continue;   // beyond, sines are not angles; below, the knee dominates
            off.push_back(all / r);
        }
        REQUIRE(off.size() > 200);
        std::ranges::sort(off);
        INFO(lens.name);
        // The knee adds a factor sqrt(1 + (knee / b)^2).
        CHECK(off[off.size() / 10] > 0.93);
        CHECK(off[off.size() / 2] == doctest::Approx(1.05).epsilon(0.08));
        CHECK(off[off.size() * 7 / 10] < 1.6);   // the rest: ghosts, which are wide
    }
}
