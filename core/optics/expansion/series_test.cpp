#include "optics/expansion/series.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "math/error.h"

using namespace dg;

namespace {

Series random_series(const Monomials& m, double constant, std::mt19937& random) {
    std::uniform_real_distribution<double> u(-1, 1);
    std::vector<double> c(m.count());
    for (double& x : c) x = u(random);
    c[0] = constant;
    return {m, std::move(c)};
}

double distance(const Series& a, const Series& b, int count) {
    double d = 0;
    for (int i = 0; i < count; ++i) d = std::max(d, std::abs(a[i] - b[i]));
    return d;
}

}  // namespace

TEST_CASE("monomials: counted, ordered by degree, multiplied and divided") {
    for (const int n : {0, 1, 4, 15}) {
        const Monomials& m = Monomials::of(n);
        CHECK(m.count() == (n + 4) * (n + 3) * (n + 2) * (n + 1) / 24);
        CHECK(m.count_to(0) == 1);
        for (int i = 1; i < m.count(); ++i) CHECK(m.degree_of(i) >= m.degree_of(i - 1));
    }
    const Monomials& m = Monomials::of(6);
    for (int i = 0; i < m.count(); ++i)
        for (int j = 0; j < m.count_to(6 - m.degree_of(i)); ++j) {
            auto sum = m.exponents(i);
            for (int v = 0; v < 4; ++v) sum[v] += m.exponents(j)[v];
            REQUIRE(m.exponents(m.product(i, j)) == sum);
        }
    for (int i = 1; i < m.count(); ++i)
        REQUIRE(m.product(m.divided(i, m.first_variable(i)),
                          m.variable(m.first_variable(i))) == i);
}

TEST_CASE("series: quotients and roots undo products, to every degree") {
    std::mt19937 random(7);
    for (const int n : {1, 2, 5, 8}) {
        const Monomials& m = Monomials::of(n);
        const Series a = random_series(m, 0.3, random),
                     b = random_series(m, -1.7, random);
        const Series r = random_series(m, 2.5, random);
        CHECK(distance(a / b * b, a, m.count()) < 1e-12);
        CHECK(distance(sqrt(r) * sqrt(r), r, m.count()) < 1e-12);
        CHECK(distance(sqrt(r * r), r, m.count()) < 1e-10);
        CHECK(distance(a * (b - r), a * b - r * a, m.count()) < 1e-13);
    }
}

TEST_CASE("series: the binomial series, and a geometric one in two variables") {
    const Monomials& m = Monomials::of(9);
    const Series x = Series::input(m, 0, 0), y = Series::input(m, 0, 1);
    const Series root = sqrt(Series(1) + x), inverse = 1.0 / (Series(1) - x - y);
    double binomial = 1;
    int power = 0;  // index of x^k
    for (int k = 0; k <= 9; ++k) {
        CHECK(root[power] == doctest::Approx(binomial).epsilon(1e-14));
        binomial *= (0.5 - k) / (k + 1);
        if (k < 9) power = m.product(power, m.variable(0));
    }
    for (int i = 0; i < m.count(); ++i) {
        const auto e = m.exponents(i);
        const double choose =
            e[2] + e[3] ? 0
                        : std::exp(std::lgamma(e[0] + e[1] + 1) - std::lgamma(e[0] + 1) -
                                   std::lgamma(e[1] + 1));
        REQUIRE(inverse[i] == doctest::Approx(choose).epsilon(1e-12));
    }
}

TEST_CASE("series: what is cut before a product is what is cut after it") {
    std::mt19937 random(3);
    const Monomials &high = Monomials::of(9), &low = Monomials::of(5);
    const Series a = random_series(high, 0.8, random),
                 b = random_series(high, 1.4, random);
    const auto cut = [&](const Series& s) {
        std::vector<double> c(low.count());
        for (int i = 0; i < low.count(); ++i) {
            // Monomials of equal degree have the same order in both.
            REQUIRE(low.exponents(i) == high.exponents(i));
            c[i] = s[i];
        }
        return Series(low, c);
    };
    CHECK(distance(a * b, cut(a) * cut(b), low.count()) < 1e-14);
    CHECK(distance(a / b, cut(a) / cut(b), low.count()) < 1e-14);
    CHECK(distance(sqrt(b), sqrt(cut(b)), low.count()) < 1e-14);
}

TEST_CASE("series: no root without a positive constant, and so many steps of Newton's") {
    const Monomials& m = Monomials::of(7);
    CHECK_THROWS_AS(sqrt(Series::input(m, 0, 0)), Error);
    CHECK_THROWS_AS(sqrt(Series(-1)), Error);
    CHECK(newton_steps(Series(3)) == 0);
    CHECK(newton_steps(Series::input(m, 0, 0)) == 3);
    CHECK(newton_steps(Series::input(Monomials::of(8), 0, 0)) == 4);
}
