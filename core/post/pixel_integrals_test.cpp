#include "post/pixel_integrals.h"

#include <doctest/doctest.h>

#include "math/error.h"

namespace dg {
namespace {

TEST_CASE("pixels are the weighted sums of their samples, 0 beyond the raster") {
    // Rows of 4; two pixels down and three across.
    const std::vector<float> samples{1, 2, 3, 4, 10, 20, 30, 40, 100, 200, 300, 400};
    const std::vector<std::int32_t> rows{-1, 1}, columns{-1, 1, 3};
    const std::vector<float> row_weights{5, 1, 0.5f, 2}, column_weights{7, 1, 1, 2, 3, 9};
    const PixelWeights down{rows, row_weights}, across{columns, column_weights};
    const std::vector<float> out = pixel_integrals(samples, 4, down, across);
    // down: row 0 by 1 (row -1 is dark); rows 1 and 2 by 0.5 and 2.
    const std::vector<float> a{1, 2, 3, 4}, b{205, 410, 615, 820};
    std::vector<float> wanted;
    for (const auto& line : {a, b})
        for (const float v : {line[0], line[1] + 2 * line[2], 3 * line[3]}) wanted.push_back(v);
    CHECK(out == wanted);
}

TEST_CASE("sizes that do not fit are refused") {
    const std::vector<float> five(5), none;
    const std::vector<std::int32_t> two(2);
    const PixelWeights good{two, {five.data(), 4}}, bad{two, five};
    CHECK_THROWS_AS(pixel_integrals(five, 5, good, bad), Error);
    CHECK_THROWS_AS(pixel_integrals(five, 2, good, good), Error);
}

}  // namespace
}  // namespace dg
