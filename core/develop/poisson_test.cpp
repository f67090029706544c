// poisson_test.cpp -- Poisson counts and normal numbers against their distributions.
#include "develop/poisson.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/statistics.h"

using namespace dg;

namespace {

constexpr int kDraws = 400000;

PixelRandom at(std::uint64_t seed, int i) { return {PixelRandom::row_key(seed, 0, i / 1000), i % 1000}; }

/// Probability of counts below k: Q(k, mean).
double below(int k, double mean) { return k <= 0 ? 0 : gamma_q(k, mean); }

double p_value(double mean, std::uint64_t seed) {
    const int low = std::max(0, int(mean - 8 * std::sqrt(mean) - 2));
    const int cells = int(16 * std::sqrt(mean) + 24);
    std::vector<double> seen(cells), wanted(cells);
    for (int i = 0; i < kDraws; ++i) {
        PixelRandom random = at(seed, i);
        const int k = int(poisson(mean, random));
        ++seen[std::clamp(k - low, 0, cells - 1)];
    }
    for (int i = 0; i < cells; ++i) {
        const double first = i == 0 ? 0 : below(low + i, mean);
        const double last = i == cells - 1 ? 1 : below(low + i + 1, mean);
        wanted[i] = kDraws * (last - first);
    }
    return chi_square_test(seen, wanted).p_value;
}

}  // namespace

TEST_CASE("poisson: counts follow the law, on both sides of where the method changes") {
    for (const double mean : {0.5, 5., 9.99, 10., 50., 500., 20000.}) {
        CAPTURE(mean);
        CHECK(p_value(mean, 1) > 1e-3);
    }
}

TEST_CASE("poisson: no light, no electrons") {
    for (int i = 0; i < 1000; ++i) {
        PixelRandom random = at(2, i);
        CHECK(poisson(0, random) == 0);
    }
}

TEST_CASE("poisson: mean and variance are equal, from few to very many") {
    for (const double mean : {0.01, 1., 30., 3000., 1e6, 1e9}) {
        CAPTURE(mean);
        double sum = 0, squares = 0;
        for (int i = 0; i < kDraws; ++i) {
            PixelRandom random = at(3, i);
            const double d = poisson(mean, random) - mean;
            sum += d;
            squares += d * d;
        }
        const double variance = squares / kDraws;
        CHECK(std::abs(sum / kDraws) < 4 * std::sqrt(mean / kDraws));
        // The fourth central moment is mean + 3 mean^2.
        CHECK(std::abs(variance - mean) < 4 * std::sqrt((mean + 2 * mean * mean) / kDraws));
    }
}

TEST_CASE("random: normal numbers follow the law, and both of a pair, and are independent") {
    constexpr int kCells = 40;
    std::vector<double> first(kCells), second(kCells), wanted(kCells, double(kDraws) / kCells);
    double product = 0;
    for (int i = 0; i < kDraws; ++i) {
        const auto [a, b] = at(4, i).normal_pair();
        ++first[std::min(kCells - 1, int(normal_cdf(a) * kCells))];
        ++second[std::min(kCells - 1, int(normal_cdf(b) * kCells))];
        product += a * b;
    }
    CHECK(chi_square_test(first, wanted).p_value > 1e-3);
    CHECK(chi_square_test(second, wanted).p_value > 1e-3);
    CHECK(std::abs(product / kDraws) < 4 / std::sqrt(kDraws));
}
