#include "develop/curve.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "math/error.h"

namespace dg {
namespace {

float srgb(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f; }

Curve sampled(float (*f)(float)) {
    std::vector<float> values;
    for (const float x : Curve::breakpoints()) values.push_back(f(x));
    return Curve(values);
}

TEST_CASE("a curve from a table is the curve, to a part of a 16-bit step") {
    const Curve curve = sampled(srgb);
    float worst = 0;
    for (float x = 1e-9f; x < 2; x *= 1.0007f) worst = std::max(worst, std::abs(curve(x) - srgb(x)));
    CHECK(worst < 1.0f / 65535);
    for (const float x : Curve::breakpoints()) CHECK(curve(x) == srgb(x));
}

TEST_CASE("outside of the table, and where there is no number") {
    const Curve curve = sampled([](float x) { return 2 + x; });
    CHECK(curve(-3) == 2);
    CHECK(curve(0) == 2);
    CHECK(curve(std::nanf("")) == 2);
    CHECK(curve(1e-8f) == doctest::Approx(2 + 1e-8));
    CHECK(curve(1e9f) == 2 + Curve::breakpoints().back());
    CHECK(curve(std::numeric_limits<float>::infinity()) == 2 + Curve::breakpoints().back());
    CHECK_THROWS_AS(Curve({1, 2, 3}), Error);
}

}  // namespace
}  // namespace dg
