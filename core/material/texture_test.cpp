// texture_test.cpp -- texels with known values.
#include "material/texture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "math/error.h"

namespace dg {
namespace {

/// 2 x 2 grey floats: 1 2 in the top row, 3 4 below.
Texture quad(Wrap wrap, TextureFilter filter = TextureFilter::linear) {
    Texture t;
    t.name = "quad";
    t.width = t.height = 2;
    t.channels = 1;
    t.pixels = std::vector<float>{1, 2, 3, 4};
    t.wrap_u = t.wrap_v = wrap;
    t.filter = filter;
    return t;
}

Texture bytes(int channels, bool srgb, std::vector<std::uint8_t> values) {
    Texture t;
    t.width = t.height = 1;
    t.channels = channels;
    t.srgb = srgb;
    t.pixels = std::move(values);
    return t;
}

}  // namespace

TEST_CASE("row 0 is the top row and uv (0,0) its left corner") {
    const Texture t = quad(Wrap::clamp);
    CHECK(t.lookup({0, 0}).r == 1);
    CHECK(t.lookup({1, 0}).r == 2);
    CHECK(t.lookup({0, 1}).r == 3);
    CHECK(t.lookup({1, 1}).r == 4);
    CHECK(t.lookup({0.25f, 0.25f}).r == 1);  // center of a texel
    CHECK(t.lookup({0.5f, 0.5f}).r == doctest::Approx(2.5));
    CHECK(t.lookup({0.375f, 0.25f}).r == doctest::Approx(1.25));
    CHECK(t.lookup({0.25f, 0.625f}).r == doctest::Approx(2.5));
}

TEST_CASE("wraps") {
    SUBCASE("repeat blends across the edge") {
        const Texture t = quad(Wrap::repeat);
        CHECK(t.lookup({0, 0.25f}).r == doctest::Approx(1.5));
        CHECK(t.lookup({1.25f, -0.75f}).r == doctest::Approx(1));
        CHECK(t.lookup({-0.25f, 7.75f}).r == doctest::Approx(4));
    }
    SUBCASE("mirror") {
        const Texture t = quad(Wrap::mirror);
        CHECK(t.lookup({-0.25f, 0.25f}).r == doctest::Approx(1));
        CHECK(t.lookup({1.25f, 0.25f}).r == doctest::Approx(2));
        CHECK(t.lookup({1.75f, 0.25f}).r == doctest::Approx(1));
        CHECK(t.lookup({1, 0.25f}).r == doctest::Approx(2));
        CHECK(t.lookup({2.25f, 1.25f}).r == doctest::Approx(3));
    }
    SUBCASE("clamp") {
        const Texture t = quad(Wrap::clamp);
        CHECK(t.lookup({-5, 0.25f}).r == 1);
        CHECK(t.lookup({5, 5}).r == 4);
    }
    SUBCASE("each axis has its own") {
        Texture t = quad(Wrap::repeat, TextureFilter::nearest);
        t.wrap_v = Wrap::clamp;
        CHECK(t.lookup({1.1f, 1.1f}).r == 3);
        CHECK(t.lookup({-0.1f, -0.1f}).r == 2);
    }
}

TEST_CASE("nearest takes one texel") {
    const Texture t = quad(Wrap::repeat, TextureFilter::nearest);
    CHECK(t.lookup({0.49f, 0}).r == 1);
    CHECK(t.lookup({0.51f, 0}).r == 2);
    CHECK(t.lookup({0.51f, 0.51f}).r == 4);
}

TEST_CASE("8-bit sRGB decodes colour and leaves alpha; linear codes are v / 255") {
    const auto decoded = bytes(4, true, {255, 188, 10, 128}).lookup({0.5f, 0.5f});
    CHECK(decoded.r == 1);
    CHECK(decoded.g == doctest::Approx(std::pow((188 / 255.0 + 0.055) / 1.055, 2.4)));
    CHECK(decoded.b == doctest::Approx(10 / 255.0 / 12.92));
    CHECK(decoded.a == doctest::Approx(128 / 255.0));
    CHECK(bytes(3, false, {51, 0, 255}).lookup({0, 0}).r == doctest::Approx(0.2));
}

TEST_CASE("missing channels: grey for one and two, opaque without alpha") {
    const auto one = bytes(1, false, {51}).lookup({0, 0});
    CHECK(one.g == one.r);
    CHECK(one.b == one.r);
    CHECK(one.a == 1);
    const auto two = bytes(2, true, {188, 51}).lookup({0, 0});
    CHECK(two.b == doctest::Approx(0.503).epsilon(0.01));
    CHECK(two.a == doctest::Approx(0.2));
    CHECK(bytes(3, false, {1, 2, 3}).lookup({0, 0}).a == 1);
}

TEST_CASE("bilinear weights mix after decoding") {
    Texture t = bytes(1, true, {0, 255});
    t.width = 2;
    CHECK(t.lookup({0.5f, 0}).r == doctest::Approx(0.5));
}

TEST_CASE("no coordinate reads outside the texture") {
    const float inf = std::numeric_limits<float>::infinity();
    const float odd[] = {
        std::nanf(""), inf,        -inf,    1e30f,  -1e30f, 3.4e38f,     -3.4e38f, 2.1e9f,
        -2.1e9f,       16777217.f, -1e-30f, 1e-30f, -1e-8f, 0.99999994f, -0.f,     1.f};
    for (Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
        for (TextureFilter filter : {TextureFilter::linear, TextureFilter::nearest}) {
            const Texture t = quad(wrap, filter);
            for (float u : odd) {
                for (float v : odd) {
                    const float r = t.lookup({u, v}).r;
                    CHECK((r >= 1 && r <= 4));  // false for NaN
                }
            }
        }
    }
    CHECK(Texture{}.lookup({0.5f, 0.5f}).g == 1);
}

TEST_CASE("a slot's transform: offset, rotation, scale of KHR_texture_transform") {
    TextureSlot s;
    CHECK(s.transform({0.3f, 0.7f}) == Vec2f{0.3f, 0.7f});
    // Offset (0.5, 0.25), scale (2, 3), turned by 90 degrees: u' = v scale_v + ..., v' =
    // -u scale_u.
    const float m[6] = {0, 3, 0.5f, -2, 0, 0.25f};
    std::copy(m, m + 6, s.m);
    CHECK(s.transform({0.1f, 0.2f}).x == doctest::Approx(1.1));
    CHECK(s.transform({0.1f, 0.2f}).y == doctest::Approx(0.05));
}

TEST_CASE("validate names the texture and what is wrong") {
    Texture t = quad(Wrap::repeat);
    CHECK_NOTHROW(t.validate());
    t.height = 3;
    CHECK_THROWS_WITH_AS(t.validate(), "texture 'quad': pixel values: wanted 6, got 4",
                         Error);
    t.height = 0;
    CHECK_THROWS_AS(t.validate(), Error);
    t = quad(Wrap::repeat);
    t.channels = 5;
    CHECK_THROWS_AS(t.validate(), Error);
    t = quad(Wrap::repeat);
    t.pixels = std::vector<float>{1, 2, std::nanf(""), 4};
    CHECK_THROWS_AS(t.validate(), Error);
}

}  // namespace dg
