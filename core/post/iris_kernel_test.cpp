#include "post/iris_kernel.h"

#include <doctest/doctest.h>

#include <map>

#include "math/error.h"
#include "math/hash.h"

namespace dg {
namespace {

IrisShape polygon(int corners, double turn = 0) {
    std::vector<Vec2d> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = turn + 2 * kPiD * i / corners;
        points.push_back({3 * std::cos(angle), 3 * std::sin(angle)});
    }
    return IrisShape::outline(points);
}

/// Coverage by pixel (dx, dy), from the changes along rows.
std::map<std::pair<int, int>, double> whole(const IrisKernel& k) {
    std::map<std::pair<int, int>, double> out;
    for (int dy = k.top; dy <= k.bottom; ++dy) {
        double sum = 0;
        int dx = k.left;
        for (int s = k.begin(dy); s < k.begin(dy + 1); ++s) {
            for (; dx < k.steps[s].dx; ++dx) out[{dx, dy}] = sum;
            sum += k.steps[s].change;
        }
        CHECK(std::abs(sum) < 1e-14);
    }
    return out;
}

TEST_CASE("a kernel sums to 1, its middle lies on the pixel, and a disc has its second moment") {
    for (double radius : {0.0, 0.0625, 0.4, 0.75, 1.3, 7.3, -20.1, 61.0}) {
        CAPTURE(radius);
        double sum = 0, x = 0, y = 0, xx = 0;
        for (const auto& [at, v] : whole(iris_kernel(polygon(256), radius))) {
            CHECK(v > -1e-12);
            sum += v, x += v * at.first, y += v * at.second, xx += v * at.first * at.first;
        }
        CHECK(sum == doctest::Approx(1).epsilon(1e-12));
        CHECK(std::abs(x) < 1e-9);
        CHECK(std::abs(y) < 1e-9);
        if (std::abs(radius) > 5)   // r^2/4, plus 1/12 for the width of the pixel
            CHECK(xx == doctest::Approx(radius * radius / 4 + 1.0 / 12).epsilon(2e-3));
    }
}

TEST_CASE("each pixel of a kernel is the area of the shape on it") {
    const IrisShape shape = polygon(5, 0.3);
    const double radius = 3.7;
    const auto kernel = whole(iris_kernel(shape, -radius));
    const auto inside = [&](Vec2d p) {   // y up
        bool in = true;
        for (const auto& e : shape.edges) {
            const Vec2d along = e.to - e.from, to = p * (1 / radius) - e.from;
            in &= along.x * to.y - along.y * to.x > 0;
        }
        return in;
    };
    const int n = 64;
    for (const auto& [at, v] : kernel) {
        int hits = 0;
        for (int i = 0; i < n * n; ++i)
            hits += inside({at.first - 0.5 + (i % n + 0.5) / n, -(at.second - 0.5 + (i / n + 0.5) / n)});
        CHECK(v * kPiD * radius * radius == doctest::Approx(hits / double(n * n)).epsilon(0.01).scale(1));
    }
}

TEST_CASE("an iris given as a picture is the same as its outline; row 0 is the top") {
    const std::vector<float> picture{0, 1, 0, 1, 1, 1};   // an inverted T
    const std::vector<Vec2d> corners{{-1.5, -1}, {1.5, -1}, {1.5, 0}, {0.5, 0},
                                     {0.5, 1},   {-0.5, 1}, {-0.5, 0}, {-1.5, 0}};
    const auto a = whole(iris_kernel(IrisShape::image(3, 2, picture), -9.3));
    const auto b = whole(iris_kernel(IrisShape::outline(corners), -9.3));
    for (const auto& [at, v] : a) CHECK(v == doctest::Approx(b.contains(at) ? b.at(at) : 0).scale(1e-3));
    CHECK(a.contains({0, -7}));
    CHECK_FALSE(a.contains({7, -7}));
}

TEST_CASE("before the focus a kernel stands upside down") {
    const auto behind = whole(iris_kernel(polygon(3), -4)), before = whole(iris_kernel(polygon(3), 4));
    for (const auto& [at, v] : behind) {
        const std::pair turned{-at.first, -at.second};
        CHECK(v == doctest::Approx(before.contains(turned) ? before.at(turned) : 0).scale(1e-3));
    }
    double x = 0;
    for (const auto& [at, v] : whole(iris_kernel(polygon(3), -4)))
        x = std::max(x, v > 1e-6 ? double(at.first) : 0);
    CHECK(x > 5);   // the corner toward +x; the opposite edge is half as far
}

TEST_CASE("kernels by radius: near the radius asked for, and none for what is no number") {
    const std::vector<float> radii{0, 0.03f, -2.51f, 15.9f, 300, NAN, INFINITY};
    const IrisKernels kernels(polygon(64), radii);
    for (int i = 0; i < 5; ++i) {
        const IrisKernel& k = kernels.at(radii[i]);
        const double r = IrisKernels::rounded(radii[i]);
        CHECK(std::abs(r - radii[i]) <= std::max(1.0 / 32, 0.002 * std::abs(radii[i])) + 1e-6);
        CHECK(kernels.reach(radii[i]) >= k.right);
        CHECK(kernels.reach(radii[i]) >= -k.top);
    }
    CHECK(kernels.at(300).steps.size() < 6000);   // the rim, not the area
}

TEST_CASE("shapes that are none are named") {
    CHECK_THROWS_AS(IrisShape::outline(std::vector<Vec2d>{{0, 0}, {0, 1}, {1, 0}}), Error);
    CHECK_THROWS_AS(IrisShape::image(1, 1, std::vector<float>{0}), Error);
    CHECK_THROWS_AS(IrisShape::image(1, 1, std::vector<float>{2}), Error);
}

}  // namespace
}  // namespace dg
