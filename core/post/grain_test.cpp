#include "post/grain.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "math/error.h"
#include "math/statistics.h"

namespace dg {
namespace {

TEST_CASE("grain is normal: mean 0, variance 1, and as many numbers in each eighth") {
    const auto field = grain_pattern({0, 0, 600, 500}, 0.4, 1, 0);   // grains smaller than a pixel: neighbours are
                                                                     // uncorrelated
    std::vector<double> counts(8), expected(8, field.size() / 8.0);
    for (const float v : field) counts[std::min(7, int(8 * normal_cdf(v)))] += 1;
    CHECK(chi_square_test(counts, expected).p_value > 1e-3);
    const std::vector<double> values(field.begin(), field.end());
    const SampleMoments m = moments(values);
    CHECK(std::abs(m.mean) < 5 / std::sqrt(m.count));
    CHECK(m.variance == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("neighbours share grains as discs overlap") {
    const int size = 700;
    const double r = 3.5;
    const auto field = grain_pattern({-20, 5, size, size}, r, 2, 1);
    for (int d : {1, 3, 5, 9}) {
        double sum = 0, squares = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x + d < size; ++x) {
                sum += double(field[y * size + x]) * field[y * size + x + d];
                squares += double(field[y * size + x]) * field[y * size + x];
            }
        const double t = std::min(1.0, d / (2 * r));
        const double overlap = (std::acos(t) - t * std::sqrt(1 - t * t)) * 2 / 3.14159265358979;
        CHECK(sum / squares == doctest::Approx(overlap).scale(1).epsilon(0.04));   // pixels soften it slightly
    }
}

TEST_CASE("a pixel's grain is that of its place, seed and layer") {
    const auto whole = grain_pattern({-3, 7, 60, 50}, 2.2, 5, 0), part = grain_pattern({17, 20, 11, 9}, 2.2, 5, 0);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 11; ++x) CHECK(part[y * 11 + x] == whole[(y + 13) * 60 + x + 20]);
    CHECK(grain_pattern({0, 0, 9, 9}, 2.2, 5, 1) != grain_pattern({0, 0, 9, 9}, 2.2, 5, 0));
    CHECK(grain_pattern({0, 0, 9, 9}, 2.2, 6, 0) != grain_pattern({0, 0, 9, 9}, 2.2, 5, 0));
    CHECK_THROWS_AS(grain_pattern({0, 0, 9, 9}, 0, 5, 0), Error);
}

}  // namespace
}  // namespace dg
