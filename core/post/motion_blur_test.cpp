#include "post/motion_blur.h"

#include <doctest/doctest.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>

#include "math/hash.h"

namespace dg {
namespace {

constexpr int kWidth = 300, kHeight = 40;

struct Case {
    std::vector<float> values = std::vector<float>(4 * kWidth * kHeight);
    std::vector<float> next = std::vector<float>(2 * kWidth * kHeight);
    std::vector<float> nearness = std::vector<float>(kWidth * kHeight);

    std::vector<float> blurred(const ShutterTime& shutter = {-0.5, 0.5, {0, 1}}) const {
        std::vector<float> last(next.size());
        for (std::size_t i = 0; i < next.size(); ++i) last[i] = -next[i];
        return motion_blur(kWidth, values, {next, last}, nearness, 0.1f, shutter, {0, kHeight});
    }
    void move(int i, float x, float y) { next[2 * i] = x, next[2 * i + 1] = y; }
};

double at(const std::vector<float>& v, int x, int y, int c = 0) { return v[4 * (y * kWidth + x) + c]; }

/// Bilinear interpolation.
double between(const std::vector<float>& v, double x, double y) {
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double u = x - i, w = y - j;
    return (1 - w) * ((1 - u) * at(v, i, j) + u * at(v, i + 1, j)) +
           w * ((1 - u) * at(v, i, j + 1) + u * at(v, i + 1, j + 1));
}

TEST_CASE("uniform motion is the integral along a line, across tiles, for any shutter") {
    Case c;
    for (std::size_t i = 0; i < c.values.size(); ++i) c.values[i] = float(hash_uniform(3, i));
    for (int i = 0; i < kWidth * kHeight; ++i) c.move(i, 9.3f, -4.1f);
    const ShutterTime rising{-0.2, 0.6, {0, 0.25, 1}};
    const auto even = c.blurred(), risen = c.blurred(rising);
    for (int x : {20, 250, 256, 262}) {
        double sum = 0, late = 0;
        const int n = 20000;
        for (int k = 0; k < n; ++k) {
            const double t = (k + 0.5) / n, a = t - 0.5, b = -0.2 + 0.8 * t;
            sum += between(c.values, x - 9.3 * a, 20 + 4.1 * a) / n;
            late += between(c.values, x - 9.3 * b, 20 + 4.1 * b) / n * (t < 0.5 ? 0.5 : 1.5);
        }
        CHECK(at(even, x, 20) == doctest::Approx(sum).epsilon(1e-5));
        CHECK(at(risen, x, 20) == doctest::Approx(late).epsilon(6e-3));   // constant within a pixel
    }
}

TEST_CASE("what stands still stays, bit for bit") {
    Case c;
    for (std::size_t i = 0; i < c.values.size(); ++i) c.values[i] = float(hash_uniform(3, i));
    CHECK(c.blurred() == c.values);
}

/// Bar of colour 1, 20 px wide, on ground of colour 0; one of the two moves by 10 px.
std::vector<float> bar(bool bar_moves, bool bar_near) {
    Case c;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const bool in = i % kWidth >= 100 && i % kWidth < 120;
        for (int k = 0; k < 4; ++k) c.values[4 * i + k] = in ? 1.f : 0.f;
        c.move(i, in == bar_moves ? 10.f : 0.f, 0);
        c.nearness[i] = in == bar_near ? 1.f : 0.f;
    }
    return c.blurred();
}

TEST_CASE("a bar that moves before still ground is a trapezoid") {
    const auto out = bar(true, true);
    for (int x = 90; x < 130; ++x) {   // half a pixel of softness at the kinks of the ramp
        const double ramp = std::clamp(std::min(x - 94.5, 124.5 - x) / 10, 0.0, 1.0);
        CHECK(at(out, x, 20) == doctest::Approx(ramp).scale(1).epsilon(0.02));
    }
}

TEST_CASE("a still bar hides what moves behind it, and what it uncovers looks like that") {
    const auto out = bar(false, true);
    for (int x = 80; x < 140; ++x) CHECK(at(out, x, 20) == doctest::Approx(x >= 100 && x < 120).epsilon(1e-9));
}

TEST_CASE("motion that is not known takes no part, and the bits do not depend on threads") {
    Case c;
    for (std::size_t i = 0; i < c.values.size(); ++i) c.values[i] = 0.25f;
    for (int i = 0; i < kWidth * kHeight; ++i) c.move(i, 7 * std::sin(float(i)), 5 * std::cos(0.3f * i));
    c.move(20 * kWidth + 50, NAN, 0);
    c.values[4 * (20 * kWidth + 50)] = 1000;
    const auto many = c.blurred();
    for (std::size_t i = 0; i < many.size(); ++i)
        if (i != 4 * (20 * kWidth + 50)) CHECK(many[i] == doctest::Approx(0.25));
    std::vector<float> one;
    oneapi::tbb::task_arena(1).execute([&] { one = c.blurred(); });
    CHECK(many == one);
}

}  // namespace
}  // namespace dg
