// grid_cdf_test.cpp -- choices in a grid against its weights.
#include "math/grid_cdf.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "math/statistics.h"

using namespace dg;

namespace {

/// Weights over six decades, some of them 0.
std::vector<double> rough_weights(int n) {
    std::vector<double> weights;
    for (int i = 0; i < n; ++i) {
        const double u = hash_uniform(n, i);
        weights.push_back(u < 0.2 ? 0 : std::pow(10, 6 * u));
    }
    return weights;
}

std::vector<std::uint32_t> table_of(const std::vector<double>& weights, int across) {
    const int down = int(weights.size()) / across;
    std::vector<std::uint32_t> table(grid_cdf_size(across, down));
    fill_grid_cdf(weights, across, down, table.data());
    return table;
}

Vec2f random_u(std::uint64_t i) {
    return {float(hash_uniform(1, i)) * 0.9999999f, float(hash_uniform(2, i)) * 0.9999999f};
}

}  // namespace

TEST_CASE("choices follow the weights, and what is left of the random numbers is uniform") {
    for (const int across : {1, 3, 8, 17}) {
        const int down = 5, n = 400000;
        const std::vector<double> weights = rough_weights(across * down);
        const std::vector<std::uint32_t> table = table_of(weights, across);
        const GuidedGrid guided(weights, across, down);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        std::vector<double> observed(weights.size() * 9), expected, wrong;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            expected.insert(expected.end(), 9, weights[i] / sum * n / 9);
            wrong.insert(wrong.end(), 9, weights[i] / sum * n / 9 * (i % 2 ? 1.02 : 0.98));
        }
        for (int i = 0; i < n; ++i) {
            Vec2d u = with_more_bits(random_u(i));
            Vec2d same = u;
            const GridCell cell = choose_in_grid(table.data(), across, down, u), again = guided.choose(same);
            const int entry = cell.row * across + cell.column;
            REQUIRE(weights[entry] > 0);
            REQUIRE((again.row == cell.row && again.column == cell.column && same.x == u.x && same.y == u.y));
            REQUIRE(u.x >= 0);
            REQUIRE(u.x < 1);
            REQUIRE(u.y >= 0);
            REQUIRE(u.y < 1);
            ++observed[entry * 9 + int(u.x * 3) * 3 + int(u.y * 3)];
        }
        CAPTURE(across);
        CHECK(chi_square_test(observed, expected).p_value > 1e-4);
        CHECK(chi_square_test(observed, wrong).p_value < 1e-3);
    }
}

TEST_CASE("a faint entry beside a bright one keeps its share") {
    std::vector<double> weights(64, 1);
    weights[40] = 1e6;
    const std::vector<std::uint32_t> table = table_of(weights, 64);
    for (int i = 0; i < 64; ++i) {
        const double end = i + 1 < 64 ? table[1 + i + 1] : 0x1p32, share = (end - table[1 + i]) * 0x1p-32;
        CHECK(share == doctest::Approx(weights[i] / 1000063).epsilon(5e-4));
    }
}

TEST_CASE("strata of the random numbers stay strata: equal weights give each entry its part of the square") {
    const int across = 8, down = 4;
    const std::vector<std::uint32_t> table = table_of(std::vector<double>(across * down, 0.1), across);
    for (int i = 0; i < across * down; ++i) {
        Vec2d u{(i % across + 0.25) / across, (i / across + 0.75) / down};
        const GridCell cell = choose_in_grid(table.data(), across, down, u);
        CHECK(cell.row * across + cell.column == i);
        CHECK(u.x == doctest::Approx(0.25));
        CHECK(u.y == doctest::Approx(0.75));
    }
}

TEST_CASE("no entry of weight 0 is chosen at either end, or where all others round to nothing") {
    const std::vector<std::vector<double>> rows = {{0, 0, 1, 0, 0}, {0, 1e-30, 1, 1e-30, 0}, {1, 1e-12, 1e-12, 0, 0},
                                                   {0, 0.1, 0.2, 0.3, 0}};
    for (const std::vector<double>& weights : rows)
        for (const double u : {0.0, 0x1p-53, 0.3, 0.5, 1 - 0x1p-32, 0x1.fffffffffffffp-1}) {
            Vec2d rest{u, u}, same = rest;
            const GridCell cell = choose_in_grid(table_of(weights, 5).data(), 5, 1, rest);
            CHECK(weights[cell.column] > 0);
            CHECK(rest.x < 1);
            CHECK(GuidedGrid(weights, 5, 1).choose(same).column == cell.column);
        }
}

TEST_CASE("more bits: the first 24 stay, the others are uniform, also for a fixed first number") {
    std::vector<double> observed(64), expected(64, 100000 / 64.0);
    for (int i = 0; i < 100000; ++i) {
        const Vec2f u{0.375f, float(i) / 100000};
        const Vec2d more = with_more_bits(u);
        REQUIRE(more.x >= 0.375);
        REQUIRE(more.x < 0.375 + 0x1p-24);
        REQUIRE(float(std::floor(more.y * 0x1p24) * 0x1p-24) <= u.y);
        REQUIRE(more.y - double(u.y) < 0x1p-24);
        const auto part = [](double v, double low) { return int((v - low) * 0x1p24 * 8); };
        ++observed[part(more.x, 0.375) * 8 + part(more.y, std::floor(more.y * 0x1p24) * 0x1p-24)];
    }
    CHECK(chi_square_test(observed, expected).p_value > 1e-4);
    CHECK(with_more_bits({1, 1}).x < 1);
}
