// keyed_test.cpp -- values between keys, and keys cut to an interval.
#include "motion/keyed.h"

#include <doctest/doctest.h>

namespace dg {

struct Number {  // in namespace dg, for argument-dependent lookup of blend()
    float x;
};
inline Number blend(Number a, Number b, float share) {
    return {a.x + (b.x - a.x) * share};
}

}  // namespace dg

using namespace dg;

namespace {

using Seconds = Keyed<Number, double>;

void check_cut(const Seconds& keys, double open, double close) {
    const Keyed<Number> cut = over(keys, open, close);
    for (int i = 0; i < 1000; ++i) {
        const float t = (float(i) + 0.5f) / 1000;
        CHECK(cut.at(t).x == doctest::Approx(keys.at(open + (close - open) * double(t)).x).epsilon(1e-4));
    }
}

}  // namespace

TEST_CASE("keys cut to an interval say the same there") {
    const Seconds keys{{1, 2, 2, 5, 6}, {{1}, {3}, {7}, {4}, {4.5f}}};
    for (const auto& [open, close] : {std::pair{0.0, 9.0}, {1.0, 6.0}, {1.2, 1.7}, {1.5, 2.5}, {4.5, 9.0},
                                      {0.0, 1.5}, {2.0, 5.0}, {5.5, 5.75}})
        check_cut(keys, open, close);
    check_cut({{-1e6, 1e6}, {{0}, {2e6f}}}, 5e5, 5e5 + 1);
}

TEST_CASE("what rests in an interval has one key; a jump at its end is not reached") {
    const Seconds keys{{1, 2, 2, 5}, {{1}, {3}, {7}, {4}}};
    CHECK_FALSE(over(keys, 0, 1).moves());
    CHECK_FALSE(over(keys, 5, 8).moves());
    CHECK_FALSE(over(keys, 1.5, 1.5).moves());
    CHECK(over(keys, 1.5, 1.5).at(0.3f).x == 2);
    CHECK(over(keys, 1, 2).at(1).x == 3);
    CHECK(over(keys, 2, 3).at(0).x == 7);
    CHECK(over(keys, 2, 2).at(0).x == 7);
    CHECK_FALSE(over(Seconds{{3}, {{8}}}, 0, 9).moves());
}
