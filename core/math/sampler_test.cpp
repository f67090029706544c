// sampler_test.cpp -- stratification, uniformity and independence of the path sampler.
#include "math/sampler.h"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

#include "math/statistics.h"

using namespace dg;

namespace {

/// Whether every dyadic box of area 2^-k (all shapes 2^-e x 2^-(k-e)) contains exactly 2^t of the
/// 2^(k+t) points.
bool is_net(const std::vector<Vec2f>& points, int k, std::size_t per_box) {
    for (int e = 0; e <= k; ++e) {
        std::vector<std::size_t> count(std::size_t(1) << k);
        for (const Vec2f p : points)
            ++count[(std::size_t(p.x * float(1 << e)) << (k - e)) |
                    std::size_t(p.y * float(1 << (k - e)))];
        for (const std::size_t c : count)
            if (c != per_box) return false;
    }
    return true;
}

std::vector<Vec2f> points(std::uint32_t begin, std::uint32_t n, std::uint64_t seed,
                          const std::function<Vec2f(PathSampler&)>& pick) {
    std::vector<Vec2f> result;
    for (std::uint32_t i = begin; i < begin + n; ++i) {
        PathSampler sampler(3, 5, i, seed);
        result.push_back(pick(sampler));
    }
    return result;
}

}  // namespace

TEST_CASE(
    "lens points and 2D pads are (0,2)-sequences: every elementary box of every block") {
    for (int k = 0; k <= 10; ++k)
        for (const std::uint32_t block : {0u, 1u, 5u}) {
            const std::uint32_t n = 1u << k;
            const auto lens = [](PathSampler& s) { return s.camera().lens; };
            const auto pad = [](PathSampler& s) {
                s.next_1d();
                return s.next_2d();
            };
            CHECK(is_net(points(block * n, n, 7, lens), k, 1));
            CHECK(is_net(points(block * n, n, 7, pad), k, 1));
        }
}

TEST_CASE("the checker refuses points that are no net") {
    auto p = points(0, 256, 7, [](PathSampler& s) { return s.camera().lens; });
    p[17].x = p[18].x;
    CHECK_FALSE(is_net(p, 8, 1));
}

TEST_CASE("every single dimension is perfectly stratified, every camera pair nearly so") {
    const auto dimension = [](PathSampler& s, int d) {
        const CameraRandom c = s.camera();
        const float all[] = {c.film.x, c.film.y, c.lens.x,   c.lens.y,
                             c.time,   c.lambda, s.next_1d()};
        return all[d];
    };
    for (int d = 0; d < 7; ++d)
        for (int k = 1; k <= 10; ++k)
            CHECK(is_net(points(0, 1u << k, 9,
                                [&](PathSampler& s) {
                                    return Vec2f{dimension(s, d), 0};
                                }),
                         0, std::size_t(1) << k));
    for (int a = 0; a < 6; ++a)
        for (int k = 1; k <= 10; ++k) {
            const auto p = points(0, 1u << k, 9, [&](PathSampler& s) {
                return Vec2f{dimension(s, a), 0};
            });
            std::vector<int> hit(std::size_t(1) << k);
            for (const Vec2f v : p) ++hit[std::size_t(v.x * float(1 << k))];
            CHECK(std::all_of(hit.begin(), hit.end(), [](int h) { return h == 1; }));
        }
    // Any pair of these six coordinates is at worst a (3,2)-net, as its polynomials guarantee.
    for (int a = 0; a < 6; ++a)
        for (int b = 0; b < a; ++b)
            for (int k = 3; k <= 10; ++k)
                CHECK(is_net(points(0, 1u << k, 9,
                                    [&](PathSampler& s) {
                                        return Vec2f{dimension(s, a), dimension(s, b)};
                                    }),
                             k - 3, 8));
}

TEST_CASE("numbers are below 1 and uniform over pixels and seeds") {
    const int cells = 64, n = 200000;
    std::vector<double> first(cells), second(cells), expected(cells, n / double(cells));
    for (int i = 0; i < n; ++i) {
        PathSampler s(i % 500, i / 500, 0, std::uint64_t(i) / 1000);
        const CameraRandom c = s.camera();
        const Vec2f p = s.next_2d();
        REQUIRE(std::max({c.film.x, c.film.y, c.lens.x, c.lens.y, c.time, c.lambda}) < 1);
        REQUIRE(std::min({c.film.x, c.film.y, c.lens.x, c.lens.y, c.time, c.lambda}) >=
                0);
        REQUIRE(std::max(p.x, p.y) < 1);
        ++first[int(c.film.x * 8) * 8 + int(p.y * 8)];
        ++second[int(c.lambda * 8) * 8 + int(c.time * 8)];
    }
    CHECK(chi_square_test(first, expected).p_value > 1e-4);
    CHECK(chi_square_test(second, expected).p_value > 1e-4);
    CHECK(unit_float(0xffffffffu) < 1.f);
}

TEST_CASE("pads are independent of each other and of the camera within one pixel") {
    const int n = 1 << 16, cells = 256;
    std::vector<double> pads(cells), pad_camera(cells),
        expected(cells, n / double(cells));
    for (int i = 0; i < n; ++i) {
        PathSampler s(11, 12, std::uint32_t(i), 3);
        const float lambda = s.camera().lambda;
        const Vec2f a = s.next_2d();
        s.next_1d();
        const Vec2f b = s.next_2d();
        ++pads[int(a.x * 16) * 16 + int(b.x * 16)];
        ++pad_camera[int(lambda * 16) * 16 + int(b.y * 16)];
    }
    CHECK(chi_square_test(pads, expected).p_value > 1e-4);
    CHECK(chi_square_test(pad_camera, expected).p_value > 1e-4);
}

TEST_CASE(
    "the planted fault is caught: one pad used twice, and 2 % of the range never "
    "reached") {
    const int n = 1 << 16, cells = 256;
    std::vector<double> twice(cells), expected(cells, n / double(cells));
    std::vector<double> tilted(cells);
    for (int i = 0; i < n; ++i) {
        PathSampler s(11, 12, std::uint32_t(i), 3);
        const Vec2f a = s.next_2d();
        ++twice[int(a.x * 16) * 16 + int(a.x * 16)];
        const double t = 0.98 * a.x;
        ++tilted[int(t * 256)];
    }
    CHECK(chi_square_test(twice, expected).p_value < 1e-9);
    CHECK(chi_square_test(tilted, expected).p_value < 1e-3);
}

TEST_CASE("a sample depends on its own index only, and pixels differ") {
    PathSampler a(1, 2, 77, 5), b(1, 2, 77, 5), c(2, 1, 77, 5);
    CHECK(a.camera().lens == b.camera().lens);
    CHECK(a.next_2d() == b.next_2d());
    CHECK(a.next_1d() == b.next_1d());
    CHECK_FALSE(a.camera().lens == c.camera().lens);
}

TEST_CASE("a smooth integral converges faster than 1/sqrt(N) and without bias") {
    const auto f = [](Vec2f p) { return std::exp(-2.0 * p.x) * (1 + p.y * p.y); };
    const double exact = (1 - std::exp(-2.0)) / 2 * (4.0 / 3);
    double squares = 0, mean = 0;
    const int seeds = 200, n = 256;
    for (int seed = 0; seed < seeds; ++seed) {
        double sum = 0;
        for (const Vec2f p :
             points(0, n, seed, [](PathSampler& s) { return s.next_2d(); }))
            sum += f(p) / n;
        squares += (sum - exact) * (sum - exact) / seeds;
        mean += sum / seeds;
    }
    const double sigma = std::sqrt(squares);
    CHECK(sigma < 0.1 * 0.36 / std::sqrt(n));  // 0.36: standard deviation of f
    CHECK(std::abs(mean - exact) < 4 * sigma / std::sqrt(seeds));
}
