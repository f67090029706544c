#include "post/interleave.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace dg;

namespace {

float value(int pixel, int channel) { return float(100 * pixel + channel); }

}  // namespace

TEST_CASE("values change between pixel by pixel and channel by channel") {
    // Sizes around the vector lengths; memory beyond must stay unchanged.
    for (int channels : {1, 2, 3, 4, 5})
        for (int count : {0, 1, 3, 4, 7, 8, 15, 16, 17, 33, 64}) {
            CAPTURE(channels);
            CAPTURE(count);
            std::vector<float> mixed;
            for (int i = 0; i < count * channels; ++i)
                mixed.push_back(value(i / channels, i % channels));
            const std::size_t plane = count + 2;
            std::vector<float> apart(plane * channels, -1);
            split_channels(mixed.data(), count, channels, apart.data(), plane);
            for (int c = 0; c < channels; ++c) {
                for (int i = 0; i < count; ++i)
                    REQUIRE(apart[c * plane + i] == value(i, c));
                REQUIRE(apart[c * plane + count] == -1);
            }
            std::vector<float> again(mixed.size() + 2, -1);
            join_channels(apart.data(), plane, count, channels, again.data());
            CHECK(std::equal(mixed.begin(), mixed.end(), again.begin()));
            CHECK(again[mixed.size()] == -1);
        }
}
