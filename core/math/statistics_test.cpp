// statistics_test.cpp -- published values, and level and power of the tests.
#include "math/statistics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "math/error.h"
#include "math/hash.h"

using namespace dg;

TEST_CASE("chi-square, Student and normal tails agree with printed tables") {
    // Abramowitz and Stegun 1964, tables 26.8 (chi-square), 26.10 (Student), 26.1 (normal).
    CHECK(chi_square_tail(3.84146, 1) == doctest::Approx(0.05).epsilon(1e-5));
    CHECK(chi_square_tail(18.3070, 10) == doctest::Approx(0.05).epsilon(1e-5));
    CHECK(chi_square_tail(149.449, 100) == doctest::Approx(0.001).epsilon(1e-4));
    CHECK(student_t_cdf(2.228, 10) == doctest::Approx(0.975).epsilon(1e-4));
    CHECK(student_t_cdf(-12.706, 1) == doctest::Approx(0.025).epsilon(1e-4));
    CHECK(normal_cdf(1.959964) == doctest::Approx(0.975).epsilon(1e-6));
    CHECK(normal_cdf(0) == 0.5);
}

TEST_CASE("identities of the incomplete gamma and beta functions") {
    for (const double x : {0.01, 0.5, 1.0, 3.0, 20.0, 400.0}) {
        CHECK(gamma_q(1, x) == doctest::Approx(std::exp(-x)).epsilon(1e-12));
        CHECK(gamma_p(0.5, x) == doctest::Approx(std::erf(std::sqrt(x))).epsilon(1e-12));
        for (const double a : {0.5, 3.0, 50.0, 500.0})
            CHECK(gamma_p(a, x) + gamma_q(a, x) == doctest::Approx(1));
    }
    for (const double x : {0.01, 0.3, 0.5, 0.9}) {
        CHECK(incomplete_beta(1, 1, x) == doctest::Approx(x));
        CHECK(incomplete_beta(2, 3, x) + incomplete_beta(3, 2, 1 - x) ==
              doctest::Approx(1));
        CHECK(incomplete_beta(2, 1, x) == doctest::Approx(x * x).epsilon(1e-12));
    }
}

namespace {

double die_p_value(std::uint64_t seed, double fault) {
    std::vector<double> counts(20), expected(20, 5000);
    for (int i = 0; i < 100000; ++i) {
        double u = hash_uniform(seed, i);
        if (u < 0.5 && hash_uniform(seed + 1000, i) < fault) u += 0.5;
        ++counts[int(u * 20)];
    }
    return chi_square_test(counts, expected).p_value;
}

}  // namespace

TEST_CASE("the chi-square test holds its level and sees a 2 % fault") {
    int false_alarms = 0;
    for (int seed = 0; seed < 100; ++seed) false_alarms += die_p_value(seed, 0) < 0.05;
    CHECK(false_alarms <= 12);  // binomial(100, 0.05): more than 12 has probability 0.001
    CHECK(false_alarms >= 1);
    CHECK(die_p_value(1, 0.02) < 1e-3);
}

TEST_CASE("small cells are pooled; a count where nothing can fall is impossible") {
    const std::vector<double> expected{1, 1, 1, 1, 2, 50, 44},
        good{2, 0, 1, 1, 2, 50, 44};
    const ChiSquareResult r = chi_square_test(good, expected);
    CHECK(r.degrees == 2);
    CHECK(r.pooled == 5);
    CHECK(r.p_value > 0.9);
    const std::vector<double> with_zero{0, 50, 50}, bad{1, 49, 50}, fine{0, 50, 50};
    CHECK(chi_square_test(bad, with_zero).p_value == 0);
    CHECK(chi_square_test(fine, with_zero).p_value > 0.9);
    CHECK_THROWS_AS(chi_square_test(fine, expected), Error);
}

TEST_CASE("Welch's test: its level, a shift that it sees, a worked example") {
    // Student's sleep data (1908), two groups of 10: t = -1.8608, 17.776 degrees of freedom, p =
    // 0.07939.
    const std::vector<double> a{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
    const std::vector<double> b{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
    CHECK(welch_p_value(moments(a), moments(b)) ==
          doctest::Approx(0.07939).epsilon(1e-3));
    int alarms = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> x, y, shifted;
        for (int i = 0; i < 400; ++i) {
            x.push_back(hash_uniform(trial, i));
            y.push_back(hash_uniform(trial + 1000, i));
            shifted.push_back(y.back() + 0.15);
        }
        alarms += welch_p_value(moments(x), moments(y)) < 0.05;
        CHECK(welch_p_value(moments(x), moments(shifted)) < 1e-3);
    }
    CHECK(alarms <= 22);
    CHECK(alarms >= 2);
    CHECK(welch_p_value({1, 0, 5}, {1, 0, 5}) == 1);
    CHECK(welch_p_value({1, 0, 5}, {2, 0, 5}) == 0);
}

TEST_CASE("Sidak's level keeps the family level") {
    CHECK(1 - std::pow(1 - sidak_level(0.05, 1000), 1000) == doctest::Approx(0.05));
}
