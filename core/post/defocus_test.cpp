#include "post/defocus.h"

#include <doctest/doctest.h>
#include <oneapi/tbb/task_arena.h>

#include <numeric>

#include "math/hash.h"

namespace dg {
namespace {

IrisShape blades(int corners) {
    std::vector<Vec2d> points;
    for (int i = 0; i < corners; ++i)
        points.push_back({std::cos(2 * kPiD * i / corners), std::sin(2 * kPiD * i / corners)});
    return IrisShape::outline(points);
}

std::vector<float> noise(std::size_t size) {
    std::vector<float> v(size);
    for (std::size_t i = 0; i < size; ++i) v[i] = float(hash_uniform(7, i));
    return v;
}

std::vector<float> blurred(int width, const std::vector<float>& values, const std::vector<float>& radius,
                           const IrisShape& iris) {
    return defocus(width, values, radius, iris, {0, int(radius.size()) / width});
}

double at(std::span<const float> values, int width, int x, int y, int c = 0) {
    return values[4 * (std::size_t(y) * width + x) + c];
}

TEST_CASE("one plane out of focus is the picture convolved with the iris, across tiles") {
    const int width = 300, height = 40;
    const auto values = noise(4 * width * height);
    for (float r : {3.0f, -4.25f}) {
        const auto out = blurred(width, values, std::vector<float>(width * height, r), blades(5));
        const IrisKernel k = iris_kernel(blades(5), r);
        for (int y : {12, 20, 27})
            for (int x : {12, 250, 255, 256, 260, 287}) {
                double sum = 0;   // summation by parts: running sums of the changes
                for (int dy = k.top; dy <= k.bottom; ++dy) {
                    double change = 0;
                    int s = k.begin(dy);
                    for (int dx = k.left; dx <= k.right; ++dx) {
                        while (s < k.begin(dy + 1) && k.steps[s].dx <= dx) change += k.steps[s++].change;
                        sum += change * at(values, width, x - dx, y - dy);
                    }
                }
                CHECK(at(out, width, x, y) == doctest::Approx(sum).epsilon(1e-6));
            }
    }
}

TEST_CASE("light far from the border is kept, however far out of focus its surface is") {
    const int width = 200, height = 90;
    std::vector<float> values(4 * width * height, 0.f), radius(width * height);
    for (int x = 60; x < 140; ++x) values[4 * (45 * width + x)] = float(hash_uniform(1, x));
    for (int i = 0; i < width * height; ++i) radius[i] = 0.15f * (i % width - 100);   // a slanted plane
    const auto out = blurred(width, values, radius, blades(64));
    const double before = std::accumulate(values.begin(), values.end(), 0.0);
    const double after = std::accumulate(out.begin(), out.end(), 0.0);
    CHECK(after == doctest::Approx(before).epsilon(0.02));
}

/// Row across an edge between a near half plane of colour 1 (left) and a far half plane of colour 0
/// (right).
std::vector<double> across_an_edge(float near, float far) {
    const int width = 120, height = 80;
    std::vector<float> values(4 * width * height), radius(width * height);
    for (int i = 0; i < width * height; ++i) {
        const bool left = i % width < 60;
        for (int c = 0; c < 4; ++c) values[4 * i + c] = left ? 1.f : 0.f;
        radius[i] = left ? near : far;
    }
    const auto out = blurred(width, values, radius, blades(128));
    std::vector<double> row(width);
    for (int x = 0; x < width; ++x) row[x] = at(out, width, x, 40);
    return row;
}

TEST_CASE("what is sharp and near keeps what is blurred and far off itself, and the other way round") {
    const auto row = across_an_edge(0, -12);
    for (int x = 0; x < 120; ++x) CHECK(row[x] == doctest::Approx(x < 60 ? 1 : 0).scale(1).epsilon(1e-6));
}

TEST_CASE("what is near and blurred covers what is sharp behind it as its disc does, on both sides of its edge") {
    const double r = 12;
    const auto row = across_an_edge(r, 0);
    for (int x = 40; x < 80; ++x) {   // fraction of a disc about x to the left of the edge
        const double t = std::clamp((59.5 - x) / r, -1.0, 1.0);
        const double share = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPiD;
        CHECK(row[x] == doctest::Approx(share).scale(1).epsilon(0.01));
    }
}

TEST_CASE("behind a blurred edge the farther surface goes on as in a mirror") {
    const int width = 120, height = 60;
    const double r = 10;
    std::vector<float> values(4 * width * height), radius(width * height);
    for (int i = 0; i < width * height; ++i) {
        const int x = i % width;
        for (int c = 0; c < 4; ++c) values[4 * i + c] = float(std::max(0, x - 60));
        radius[i] = x < 60 ? float(r) : 0.f;
    }
    const auto out = blurred(width, values, radius, blades(128));
    for (int x = 51; x < 60; ++x) {   // black foreground covers a fraction of the lens
        const double t = (59.5 - x) / r;
        const double share = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPiD;
        CHECK(at(out, width, x, 30) == doctest::Approx((1 - share) * (59 - x)).scale(1).epsilon(0.05));
    }
}

TEST_CASE("a mixed pixel on an edge gives each surface its own light") {
    // Sharp lamp in front of an unsharp wall. The pixels between them are two fifths lamp, with the
    // depth of the wall.
    const int width = 90, height = 60;
    std::vector<float> values(4 * width * height), radius(width * height);
    for (int i = 0; i < width * height; ++i) {
        const int x = i % width;
        for (int c = 0; c < 4; ++c) values[4 * i + c] = x < 45 ? 100.f : x == 45 ? 40.6f : 1.f;
        radius[i] = x < 45 ? 0.f : -8.f;
    }
    const auto out = blurred(width, values, radius, blades(64));
    CHECK(at(out, width, 44, 30) == doctest::Approx(100));
    CHECK(at(out, width, 45, 30) == doctest::Approx(40.6));
    for (int x = 46; x < 70; ++x) CHECK(at(out, width, x, 30) == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE("pixels that are not finite stay, and poison nothing; those without depth give nothing") {
    const int width = 60, height = 50;
    std::vector<float> values(4 * width * height, 0.5f), radius(width * height, 5.f);
    values[4 * (20 * width + 30) + 1] = NAN;
    values[4 * (30 * width + 30)] = INFINITY;
    radius[25 * width + 10] = NAN;
    values[4 * (25 * width + 10)] = 99;
    const auto out = blurred(width, values, radius, blades(6));
    for (int i = 0; i < width * height; ++i)
        if (i != 20 * width + 30 && i != 30 * width + 30)
            for (int c = 0; c < 4; ++c) CHECK(out[4 * i + c] == doctest::Approx(0.5));
    CHECK(std::isnan(at(out, width, 30, 20, 1)));
    CHECK(std::isinf(at(out, width, 30, 30)));
}

TEST_CASE("the same bits on one thread and on many") {
    const int width = 600, height = 300;
    const auto values = noise(4 * width * height);
    std::vector<float> radius(width * height);
    for (int i = 0; i < width * height; ++i) radius[i] = float(i % width / 100 * 3 - 6);
    const auto many = blurred(width, values, radius, blades(7));
    std::vector<float> one;
    oneapi::tbb::task_arena(1).execute([&] { one = blurred(width, values, radius, blades(7)); });
    CHECK(many == one);
}

TEST_CASE("some of the rows are those of the whole") {
    const int width = 90, height = 120;
    const auto values = noise(4 * width * height);
    std::vector<float> radius(width * height);
    for (int i = 0; i < width * height; ++i) radius[i] = float(i / width / 20 * 2 - 4);
    const auto whole = blurred(width, values, radius, blades(7));
    const auto part = defocus(width, values, radius, blades(7), {40, 77});
    REQUIRE(part.size() == std::size_t(4 * width * 37));
    for (std::size_t i = 0; i < part.size(); ++i) CHECK(part[i] == doctest::Approx(whole[4 * width * 40 + i]).epsilon(1e-6));
}

TEST_CASE("blur larger than the picture, and pictures of one pixel") {
    CHECK(blurred(1, std::vector<float>{1, 2, 3, 1}, std::vector<float>{50}, blades(6)) ==
          std::vector<float>{1, 2, 3, 1});
    const auto out = blurred(4, std::vector<float>(16, 2.f), std::vector<float>(4, -500.f), blades(6));
    for (float v : out) CHECK(v == doctest::Approx(2));
}

}  // namespace
}  // namespace dg
