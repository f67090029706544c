#include "film/neighbours.h"

#include <doctest/doctest.h>

#include <cstdlib>

namespace dg {
namespace {

int colour(int x, int y) { return (x + 2 * y) % 3; }

TEST_CASE("each pixel hears those of the next colour within reach, and nobody else") {
    const int width = 9, height = 7, reach = 2;
    for (int own = 0; own < width * height; ++own) {
        std::vector<float> plane(width * height, 0.f);
        plane[own] = 1;
        const auto heard = mean_of_next_colour(plane, width, reach);
        for (int i = 0; i < width * height; ++i) {
            const int dx = std::abs(i % width - own % width), dy = std::abs(i / width - own / width);
            const bool near = dx <= reach && dy <= reach;
            const bool next = colour(own % width, own / width) ==
                              (colour(i % width, i / width) + 1) % 3;
            CHECK((heard[i] > 0) == (near && next));
        }
    }
}

TEST_CASE("a mean of neighbours: the same everywhere stays so; of one pixel, the plane's") {
    for (int width : {1, 2, 3, 8}) {
        const std::vector<float> same(8 * width, 0.3f);
        for (float v : mean_of_next_colour(same, width, 3)) CHECK(v == doctest::Approx(0.3f));
    }
    CHECK(mean_of_next_colour(std::vector<float>{5}, 1, 3) == std::vector<float>{5});
    CHECK(mean_of_next_colour(std::vector<float>{5, 1}, 2, 3) == std::vector<float>{1, 3});
}

TEST_CASE("who is nearer has more to say: by the inverse square of the distance") {
    const auto heard = [](int neighbour) {
        std::vector<float> plane(11 * 11, 0.f);
        plane[neighbour] = 1;
        return mean_of_next_colour(plane, 11, 4)[5 * 11 + 5];
    };
    const float near = heard(5 * 11 + 6);
    CHECK(near > 0);
    CHECK(near / heard(5 * 11 + 3) == doctest::Approx(4));
    CHECK(near / heard(6 * 11 + 4) == doctest::Approx(2));
}

}  // namespace
}  // namespace dg
