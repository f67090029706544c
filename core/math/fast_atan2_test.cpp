// fast_atan2_test.cpp -- accuracy of the fast atan2 in all directions.
#include "math/fast_atan2.h"

#include <doctest/doctest.h>

#include "math/hash.h"
#include "math/vec.h"

using namespace dg;

TEST_CASE("fast atan2 is close to atan2 in all octants, for vectors of any length") {
    double worst = 0;
    for (int i = 0; i < 400000; ++i) {
        const double angle = (2 * hash_uniform(1, i) - 1) * kPiD, length = std::exp(60 * hash_uniform(2, i) - 30);
        const float x = float(length * std::cos(angle)), y = float(length * std::sin(angle));
        worst = std::max(worst, std::abs(fast_atan2(y, x) - std::atan2(double(y), double(x))));
    }
    CHECK(worst < 4e-7);
    CHECK(worst > 1e-8);
}

TEST_CASE("fast atan2 on the axes, on diagonals and at zero") {
    CHECK(fast_atan2(0, 0) == 0);
    CHECK(fast_atan2(0, 2) == 0);
    CHECK(fast_atan2(3, 0) == float(kPiD / 2));
    CHECK(fast_atan2(-3, 0) == -float(kPiD / 2));
    CHECK(fast_atan2(0, -1) == float(kPiD));
    CHECK(fast_atan2(-0.f, -1) == -float(kPiD));
    for (const float y : {-1.f, 1.f})
        for (const float x : {-1.f, 1.f})
            CHECK(fast_atan2(y, x) == doctest::Approx(std::atan2(double(y), double(x))).epsilon(1e-6));
}
