#include "develop/picture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "develop/sharpen.h"
#include "math/error.h"

namespace dg {
namespace {

const Vec3f kLuminance{0.2126f, 0.7152f, 0.0722f};

float luminance(const Vec3f& v) { return dot(v, kLuminance); }

Curve curve_of(float (*f)(float)) {
    std::vector<float> values;
    for (const float x : Curve::breakpoints()) values.push_back(f(x));
    return Curve(values);
}

Vec3f one(const Development& how, const Vec3f& v) {
    const float in[3] = {v.x, v.y, v.z};
    float out[3];
    develop(how, std::span<const float>(in), std::span<float>(out));
    return {out[0], out[1], out[2]};
}

void check_near(const Vec3f& got, const Vec3f& wanted) {
    CHECK(got.x == doctest::Approx(wanted.x).scale(1).epsilon(1e-5));
    CHECK(got.y == doctest::Approx(wanted.y).scale(1).epsilon(1e-5));
    CHECK(got.z == doctest::Approx(wanted.z).scale(1).epsilon(1e-5));
}

TEST_CASE("colours outside of the gamut keep luminance and hue") {
    for (const Vec3f& rgb : {Vec3f{-0.2f, 0.5f, 0.1f}, Vec3f{3, -0.5f, 0.4f}, Vec3f{0.3f, 0.2f, -0.4f}}) {
        const Vec3f in = into_gamut(rgb, kLuminance);
        CHECK(luminance(in) == doctest::Approx(luminance(rgb)));
        CHECK(std::min({in.x, in.y, in.z}) == doctest::Approx(0).scale(1));
        const float y = luminance(rgb), t = (in.x - y) / (rgb.x - y);   // on the line to the neutral
        check_near(in, {y + t * (rgb.x - y), y + t * (rgb.y - y), y + t * (rgb.z - y)});
    }
    check_near(into_gamut({-1, 0.1f, 0.2f}, kLuminance), {0, 0, 0});
    check_near(into_gamut({0.2f, 0, 5}, kLuminance), {0.2f, 0, 5});
}

TEST_CASE("light above white keeps its hue and gets the whiter the brighter it is") {
    check_near(below_white({5, 1, 0}), {1, 0.6f, 0.5f});
    check_near(below_white({2, 2, 2}), {1, 1, 1});
    check_near(below_white({0.9f, 1.0f, 0.1f}), {0.9f, 1.0f, 0.1f});
    Vec3f last{0, 0, 0};
    for (float light = 0.1f; light < 1e6f; light *= 1.1f) {
        const Vec3f shown = below_white({light, 0.3f * light, 0.1f * light});
        CHECK(shown.x <= 1);
        CHECK(luminance(shown) > luminance(last) - 1e-6f);
        last = shown;
    }
    CHECK(last.z > 0.999f);
}

TEST_CASE("balance, matrix and encoding follow each other") {
    Development how;
    how.balance = {2, 1, 4};
    how.rgb_from_balanced = {1, 0.5f, 0, 0, 1, 0, 0, 0.25f, 1};
    check_near(one(how, {0.1f, 0.2f, 0.05f}), {0.3f, 0.2f, 0.25f});
    how.encode = curve_of([](float x) { return std::sqrt(x); });
    check_near(one(how, {0.1f, 0.2f, 0.05f}), {std::sqrt(0.3f), std::sqrt(0.2f), 0.5f});
}

TEST_CASE("highlights: clip is white, blend keeps brightness, reconstruct asks the others") {
    Development how;
    how.balance = {2, 1, 1.5f};
    how.full = {1, 1, 1};
    check_near(one(how, {1, 1, 1}), {1, 1, 1});   // not magenta
    how.highlights = HighlightRule::blend;
    check_near(one(how, {1, 1, 1}), {1.5f, 1.5f, 1.5f});
    check_near(one(how, {0.3f, 0.4f, 0.2f}), {0.6f, 0.4f, 0.3f});
    const Vec3f red = one(how, {1, 0.05f, 0.02f});   // a red lamp stays red
    CHECK(red.x > 3 * red.y);
    how.highlights = HighlightRule::reconstruct;
    check_near(one(how, {1, 1, 1}), {2, 2, 2});
    check_near(one(how, {0.8f, 1, 0.9f}), {1.6f, 1.475f, 1.35f});
    check_near(one(how, {1, 0.05f, 0.02f}), {2, 0.05f, 0.03f});
    CHECK_THROWS_AS(highlights_of("crop"), Error);
}

TEST_CASE("a tone curve leaves greys grey and hues in their order") {
    Development how;
    how.tone = curve_of([](float x) { return x / (x + 1); });
    how.encode = curve_of([](float x) { return x; });
    check_near(one(how, {1, 1, 1}), {0.5f, 0.5f, 0.5f});
    check_near(one(how, {3, 2, 1}), {0.75f, 0.625f, 0.5f});
}

TEST_CASE("numbers that are none, and 16 bits as floats") {
    Development how;
    how.encode = curve_of([](float x) { return std::min(x, 1.0f); });
    check_near(one(how, {std::nanf(""), 0, 0}), {0, 0, 0});
    const float inf = Development::kNever;
    check_near(one(how, {inf, inf, inf}), {1, 1, 1});
    how.balance = {1e-4f, 1e-4f, 1e-4f};
    std::vector<std::uint16_t> whole;
    std::vector<float> same;
    for (int i = 0; i < 30000; ++i) whole.push_back((i * 7919) & 0xffff), same.push_back(whole.back());
    std::vector<float> a(whole.size()), b(whole.size());
    develop(how, std::span<const std::uint16_t>(whole), std::span<float>(a));
    develop(how, std::span<const float>(same), std::span<float>(b));
    CHECK(a == b);
    CHECK_THROWS_AS(develop(how, std::span<const float>(same), std::span<float>(a).first(3)), Error);
}

TEST_CASE("sharpening: flat stays flat, an edge gets steeper by the stated amount") {
    const float weights[3] = {0.2f, 0.7f, 0.1f};
    std::vector<float> flat(3 * 20 * 10, 0.4f);
    sharpen(flat, 20, 10, weights, 1, 1.5f);
    for (const float v : flat) CHECK(v == doctest::Approx(0.4f));
    std::vector<float> dot(3 * 21 * 21, 0.0f);
    for (int k = 0; k < 3; ++k) dot[3 * (10 * 21 + 10) + k] = 1;
    sharpen(dot, 21, 21, weights, 0.5f, 1);
    const double middle = 0.39905 * 0.39905;   // Gaussian of 1 px at whole px, truncated at 3 px
    CHECK(dot[3 * (10 * 21 + 10)] == doctest::Approx(1 + 0.5 * (1 - middle)).epsilon(1e-4));
    CHECK(dot[3 * (10 * 21 + 11)] == doctest::Approx(-0.5 * middle * std::exp(-0.5)).epsilon(1e-4));
    CHECK_THROWS_AS(sharpen(dot, 20, 21, weights, 1, 1), Error);
    CHECK_THROWS_AS(sharpen(dot, 21, 21, weights, 1, 0), Error);
}

}  // namespace
}  // namespace dg
