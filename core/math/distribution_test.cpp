// distribution_test.cpp -- tabulated distributions against their weights.
#include "math/distribution.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/error.h"
#include "math/hash.h"
#include "math/statistics.h"

using namespace dg;

namespace {

std::vector<float> rough_weights(int n, std::uint64_t seed) {
    std::vector<float> w(n);
    for (int i = 0; i < n; ++i) {
        const double u = hash_uniform(seed, i);
        w[i] = u < 0.2 ? 0.f : float(std::exp(6 * u));
    }
    return w;
}

double discrete_p_value(const DiscreteDistribution& d,
                        const std::vector<float>& weights) {
    const int n = 400000;
    double sum = 0;
    for (const float w : weights) sum += w;
    std::vector<double> observed(weights.size() * 4), expected;
    for (const float w : weights) expected.insert(expected.end(), 4, w / sum * n / 4);
    for (int i = 0; i < n; ++i) {
        const DiscreteSample s = d.sample(float(hash_uniform(5, i)) * 0.9999999f);
        ++observed[s.index * 4 + int(s.u_remapped * 4)];
    }
    return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("discrete: frequencies, remapped number and pmf") {
    for (const int n : {1, 2, 7, 300}) {
        std::vector<float> w = rough_weights(n, n);
        w[0] = 1;
        const DiscreteDistribution d{std::span<const float>(w)};
        CHECK(discrete_p_value(d, w) > 1e-4);
        double sum = 0, total = 0;
        for (const float v : w) total += v;
        for (int i = 0; i < n; ++i) {
            sum += d.pmf(i);
            CHECK(d.pmf(i) == doctest::Approx(w[i] / total).epsilon(1e-6));
        }
        CHECK(sum == doctest::Approx(1));
        CHECK(d.sum() == doctest::Approx(total));
    }
}

TEST_CASE("discrete: a weight that is 2 % wrong is caught") {
    std::vector<float> w(50, 1.f);
    const DiscreteDistribution d{std::span<const float>(w)};
    CHECK(discrete_p_value(d, w) > 1e-4);
    for (int i = 0; i < 50; ++i) w[i] *= i % 2 ? 1.02f : 0.98f;
    CHECK(discrete_p_value(d, w) < 1e-3);
}

TEST_CASE(
    "discrete: zero weights are never chosen, whatever u, and u may be the largest "
    "float") {
    const std::vector<float> w{0, 0, 1, 0, 1e-9f, 0, 3, 0, 0};
    const DiscreteDistribution d{std::span<const float>(w)};
    for (int i = 0; i <= 100000; ++i) {
        const float u = std::min(float(i) / 100000, 0x1.fffffep-1f);
        const DiscreteSample s = d.sample(u);
        REQUIRE(w[s.index] > 0);
        REQUIRE(s.u_remapped >= 0);
        REQUIRE(s.u_remapped < 1);
    }
    CHECK(d.sample(0).index == 2);
    CHECK(d.sample(1.f).index == 6);
}

TEST_CASE("discrete: extreme ranges need no linear search and stay exact") {
    std::vector<float> w(100000, 1e-6f);
    w[99990] = 1e6f;
    const DiscreteDistribution d{std::span<const float>(w)};
    CHECK(d.sample(0.5f).index == 99990);
    CHECK(d.pmf(3) == doctest::Approx(1e-12).epsilon(1e-3));
}

TEST_CASE("continuous 1D density") {
    const std::vector<float> w{1, 3, 0, 4};
    const DiscreteDistribution d{std::span<const float>(w)};
    for (int i = 0; i < 1000; ++i) {
        const ContinuousSample1D s = d.sample_continuous(float(i) / 1000);
        CHECK(s.pdf == doctest::Approx(d.pdf_continuous(s.x)));
        CHECK(s.pdf == doctest::Approx(w[s.index] / 2.0));
    }
    CHECK(d.pdf_continuous(1.f) == 0);
    CHECK(d.pdf_continuous(-0.1f) == 0);
}

TEST_CASE("2D: chi-square against the values, density consistent, zeros never hit") {
    const int width = 37, height = 11, n = 200000;
    std::vector<float> values = rough_weights(width * height, 3);
    for (int x = 0; x < width; ++x) values[4 * width + x] = 0;  // an empty row
    const Distribution2D d(width, height, values);
    double sum = 0;
    for (const float v : values) sum += v;
    CHECK(d.integral() == doctest::Approx(sum / (width * height)));
    std::vector<double> observed(values.size()), expected, wrong;
    for (const float v : values) expected.push_back(v / sum * n);
    for (int i = 0; i < n; ++i) {
        const Sample2D s = d.sample({float(hash_uniform(1, i)) * 0.9999999f,
                                     float(hash_uniform(2, i)) * 0.9999999f});
        const int x = int(s.x * width), y = int(s.y * height);
        REQUIRE(x < width);
        REQUIRE(y < height);
        ++observed[y * width + x];
        REQUIRE(s.pdf == doctest::Approx(d.pdf(s.x, s.y)).epsilon(1e-4));
        REQUIRE(
            s.pdf ==
            doctest::Approx(values[y * width + x] / sum * width * height).epsilon(1e-3));
    }
    CHECK(chi_square_test(observed, expected).p_value > 1e-4);
    for (std::size_t i = 0; i < expected.size(); ++i)
        wrong.push_back(expected[i] * (i % 2 ? 1.02 : 0.98));
    CHECK(chi_square_test(observed, wrong).p_value < 1e-3);
    CHECK(d.pdf(0.5f, 4.5f / height) == 0);
    CHECK(d.pdf(1.f, 0.5f) == 0);
}

TEST_CASE("bad weights are refused with place and value") {
    const auto build = [](std::vector<float> w) {
        return DiscreteDistribution{std::span<const float>(w)};
    };
    CHECK_THROWS_AS(build({}), Error);
    CHECK_THROWS_AS(build({0, 0}), Error);
    CHECK_THROWS_AS(build({1, -1}), Error);
    CHECK_THROWS_AS(build({1, std::nanf("")}), Error);
    CHECK_THROWS_AS(build({1, std::numeric_limits<float>::infinity()}), Error);
    const std::vector<float> five(5, 1.f);
    CHECK_THROWS_AS(Distribution2D(2, 3, five), Error);
}
