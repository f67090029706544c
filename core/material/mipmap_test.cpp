// mipmap_test.cpp -- pyramids preserve the mean of light, and footprints choose the correct level.
#include "material/mipmap.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "material/texture.h"
#include "math/hash.h"

namespace dg {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <typename T>
Texture image(int width, int height, int channels, std::vector<T> values, bool srgb = false,
              bool weigh_by_alpha = false) {
    Texture t;
    t.width = width, t.height = height, t.channels = channels, t.srgb = srgb;
    t.pixels = SharedArray<T>(std::move(values));
    t.pyramid = build_pyramid(t, weigh_by_alpha);
    return t;
}

/// Square footprint with a width of `texels`.
UvFootprint wide(const Texture& t, float texels) {
    return {{texels / float(t.width), 0}, {0, texels / float(t.height)}};
}

/// Alternating columns of 0 and 255.
Texture stripes(int size, bool srgb) {
    Bytes values;
    for (int i = 0; i < size * size; ++i) values.push_back(i % 2 ? 255 : 0);
    return image(size, size, 1, values, srgb);
}

}  // namespace

TEST_CASE("a texture of one colour is the same at every level, in every code and size") {
    for (const bool srgb : {false, true}) {
        for (int channels = 1; channels <= 4; ++channels) {
            for (int code = 0; code < 256; ++code) {
                const Texture t = image(6, 5, channels, Bytes(30 * channels, code), srgb);
                for (std::uint8_t v : std::get<Bytes>(t.pyramid->values)) CHECK(v == code);
            }
        }
    }
}

TEST_CASE("every level has the mean of the texture, also where sizes are odd") {
    for (const auto& [w, h] : {std::pair{7, 5}, {8, 8}, {1, 13}, {100, 3}, {31, 17}}) {
        std::vector<float> values(w * h);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(hash_uniform(3, i));
        const double mean = std::accumulate(values.begin(), values.end(), 0.0) / (w * h);
        const Texture t = image(w, h, 1, values);
        const auto& levels = t.pyramid->levels;
        const auto& p = std::get<std::vector<float>>(t.pyramid->values);
        CHECK(levels[0].width == std::max(w / 2, 1));
        CHECK(levels.back().width * levels.back().height == 1);
        for (const Pyramid::Level& l : levels) {
            const auto* first = p.data() + l.offset;
            const int n = l.width * l.height;
            CHECK(std::accumulate(first, first + n, 0.0) / n == doctest::Approx(mean).epsilon(1e-6));
        }
    }
}

TEST_CASE("8-bit means do not drift: noise of 512 x 512 keeps its light to a third of a code") {
    for (const bool srgb : {false, true}) {
        Bytes values(512 * 512 * 3);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = std::uint8_t(256 * hash_uniform(9, i));
        const Texture t = image(512, 512, 3, values, srgb);
        double sum = 0;
        for (int y = 0; y < 512; ++y)
            for (int x = 0; x < 512; ++x)
                sum += t.lookup({(x + 0.5f) / 512, (y + 0.5f) / 512}).g;
        const double mean = sum / (512 * 512);
        CHECK(t.lookup({0.3f, 0.7f}, wide(t, 64)).g == doctest::Approx(mean).epsilon(0.05));
        // A level of 8 x 8.
        double far = 0;
        for (int i = 0; i < 64; ++i)
            far += t.lookup({(i % 8 + 0.5f) / 8, (i / 8 + 0.5f) / 8}, wide(t, 64)).g / 64;
        CHECK(std::abs(far - mean) < 0.0013);
    }
}

TEST_CASE("stripes far away read their mean of light; in sRGB that is no mean of codes") {
    for (const bool srgb : {false, true}) {
        const Texture t = stripes(64, srgb);
        for (const float texels : {2.f, 5.f, 64.f, 1e6f})
            CHECK(t.lookup({0.123f, 0.4f}, wide(t, texels)).r == doctest::Approx(0.5).epsilon(0.01));
        CHECK(t.lookup({0.5f / 64, 0.5f}, wide(t, 0.9f)).r == 0);  // close up: the texel
    }
}

TEST_CASE("sRGB of odd size: a third of white is a third of its light, not of its code") {
    const Texture t = image(3, 1, 1, Bytes{0, 0, 255}, true);
    CHECK(t.lookup({0.5f, 0.5f}, wide(t, 9)).r == doctest::Approx(1 / 3.0).epsilon(0.003));
    const Texture whole = image(3, 3, 3, Bytes(27, 188), true);
    CHECK(whole.lookup({0.5f, 0.5f}, wide(whole, 9)).g == whole.lookup({0.5f, 0.5f}).g);
}

TEST_CASE("transparent texels give no colour where alpha weighs") {
    const Bytes leaf{200, 10, 0, 255, 0, 0, 255, 0};
    Texture t = image(2, 1, 4, leaf, false, true);
    auto c = t.lookup({0.5f, 0.5f}, wide(t, 4));
    CHECK(c.r == doctest::Approx(200 / 255.0));
    CHECK(c.b == 0);
    CHECK(c.a == doctest::Approx(0.5).epsilon(0.01));
    t = image(2, 1, 4, leaf);
    CHECK(t.lookup({0.5f, 0.5f}, wide(t, 4)).b == doctest::Approx(0.5).epsilon(0.01));
    t = image(2, 1, 4, Bytes{200, 10, 0, 0, 0, 10, 100, 0}, false, true);  // fully transparent
    CHECK(t.lookup({0.5f, 0.5f}, wide(t, 4)).g == doctest::Approx(10 / 255.0));
}

TEST_CASE("the level is log2 of the shorter axis in texels, unless the other is too long") {
    const Texture t = stripes(256, false);
    CHECK(t.level(wide(t, 8)) == doctest::Approx(3));
    CHECK(t.level(wide(t, 1)) == 0);
    CHECK(t.level(wide(t, 0)) == 0);
    CHECK(t.level({{8 / 256.f, 0}, {0, 16 / 256.f}}) == doctest::Approx(3));
    CHECK(t.level({{8 / 256.f, 0}, {0, 1.f}}) == t.level({{1.f, 0}, {0, 8 / 256.f}}));
    CHECK(t.level({{8 / 256.f, 0}, {0, 1.f}}) > 4);
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    CHECK(t.lookup({0.1f, 0.1f}, {{nan, 0}, {0, nan}}).r >= 0);
    CHECK(t.lookup({0.1f, 0.1f}, {{inf, 0}, {0, inf}}).r == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("the six filters of glTF for minified texels") {
    // Levels of a 4 x 4 ramp: 0 ... 15, then 2.5 4.5 / 10.5 12.5, then 7.5.
    std::vector<float> ramp(16);
    std::iota(ramp.begin(), ramp.end(), 0.f);
    Texture t = image(4, 4, 1, ramp);
    using Mip = MinFilter::Mip;
    const Vec2f uv{0.3f, 0.2f};  // a quarter of a texel off centers of level 0
    const auto read = [&](TextureFilter within, Mip between, float texels) {
        t.min_filter = {within, between};
        return t.lookup(uv, wide(t, texels)).r;
    };
    const float fine = t.lookup(uv).r;
    constexpr auto kNearest = TextureFilter::nearest, kLinear = TextureFilter::linear;
    CHECK(read(kLinear, Mip::none, 4) == fine);
    CHECK(read(kNearest, Mip::none, 4) == 1);
    CHECK(read(kNearest, Mip::nearest, 2.2f) == 2.5f);
    CHECK(read(kNearest, Mip::nearest, 3.5f) == 7.5f);
    CHECK(read(kNearest, Mip::linear, std::sqrt(8.f)) == doctest::Approx(5));
    const float middle = read(kLinear, Mip::nearest, 2);
    CHECK(middle == doctest::Approx(2.5 + 0.1 * 2 + 0.1 * 8));  // 0.1 off a center
    CHECK(read(kLinear, Mip::linear, std::sqrt(8.f)) == doctest::Approx(0.5 * (middle + 7.5)));
    CHECK(read(kLinear, Mip::linear, 1.0001f) == doctest::Approx(fine).epsilon(1e-3));
}

TEST_CASE("wraps hold at every level") {
    Texture t = image(4, 1, 1, std::vector<float>{0, 0, 8, 8});  // level 1: 0 8
    const UvFootprint two = wide(t, 2);
    CHECK(t.lookup({0, 0}, two).r == doctest::Approx(4));
    t.wrap_u = Wrap::clamp;
    CHECK(t.lookup({0, 0}, two).r == 0);
    CHECK(t.lookup({9, 0}, two).r == 8);
    t.wrap_u = Wrap::mirror;
    CHECK(t.lookup({1, 0}, two).r == 8);
    CHECK(t.lookup({-0.25f, 0}, two).r == 0);
}

TEST_CASE("a pyramid is a third of the texture, and none is made of one texel") {
    const Texture t = image(1024, 512, 3, Bytes(1024 * 512 * 3));
    CHECK(std::get<Bytes>(t.pyramid->values).size() <= 1024 * 512 + 64);
    CHECK(image(1, 1, 3, Bytes{1, 2, 3}).pyramid == nullptr);
}

}  // namespace dg
