// environment_test.cpp -- lookup conventions, and samples against densities, including bright texels.
#include "light/environment.h"

#include <doctest/doctest.h>

#include "light/direction_test.h"
#include "math/error.h"

using namespace dg;

namespace {

EnvironmentImage noise_image(int width, int height, std::uint64_t seed) {
    EnvironmentImage image{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        image.pixels.push_back({float(hash_uniform(seed, 3 * i)),
                                float(hash_uniform(seed, 3 * i + 1)),
                                float(hash_uniform(seed, 3 * i + 2))});
    }
    return image;
}

/// A black picture with one bright texel.
EnvironmentImage hot_image(int width, int height, int row, int column, float hot,
                           float rest) {
    EnvironmentImage image{
        width, height, std::vector<Rgb>(std::size_t(width) * height, {rest, rest, rest})};
    image.pixels[std::size_t(row) * width + column] = {hot, hot, hot};
    return image;
}

Affine3f rotation() {
    const Vec3f z = normalize(Vec3f{0.3f, -0.5f, 0.8f});
    const Frame f = Frame::from_normal(z);
    return {f.x, f.y, f.z, {}};
}

double p_value(const Environment& e, double fault = 1, int samples = 200000,
               DirectionGrid grid = {}) {
    return direction_p_value(
        grid, [&](Vec2f u) { return std::optional(e.sample(u, 0).direction); },
        [&](Vec3f w) { return fault * e.pdf(w, 0); }, samples, 24);
}

/// Integral over the sphere by stratified directions.
template <typename F>
double integrate(F f, int n = 600) {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < 2 * n; ++j) {
            const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z);
            const double phi = kPiD * (j + 0.5) / n;
            sum += f(Vec3f{float(r * std::cos(phi)), float(z), float(r * std::sin(phi))});
        }
    }
    return sum * 4 * kPiD / (2.0 * n * n);
}

}  // namespace

TEST_CASE(
    "picture: zenith on top, the centre column along -z, the right half toward +x") {
    EnvironmentImage image{8, 4, std::vector<Rgb>(32)};
    image.pixels[0 * 8 + 3] = {1, 0, 0};
    for (int c = 0; c < 8; ++c) image.pixels[c] = {5, 0, 0};  // top row
    for (int r = 1; r < 4; ++r) {
        image.pixels[r * 8 + 3] = image.pixels[r * 8 + 4] = {0, 1, 0};  // centre
        image.pixels[r * 8 + 5] =
            image.pixels[r * 8 + 6] = {0, 0, 1};  // a quarter to the right
    }
    const Environment e = Environment::image(image, 2, {});
    CHECK(e.luminance({0, 1, 0}, 0).x == doctest::Approx(10));
    CHECK(e.luminance({0, -0.6f, -0.8f}, 0).y == doctest::Approx(2));
    CHECK(e.luminance({0.8f, -0.6f, 0}, 0).z == doctest::Approx(2));
    CHECK(e.luminance({-0.8f, -0.6f, 0}, 0).z == 0);
}

TEST_CASE("the transform turns the picture") {
    const EnvironmentImage image = noise_image(8, 4, 1);
    const Environment still = Environment::image(image, 1, {}),
                      turned = Environment::image(image, 1, rotation());
    for (Vec3f d :
         {Vec3f{0, 0.8f, 0.6f}, Vec3f{0.6f, 0, -0.8f}, Vec3f{-0.48f, 0.6f, 0.64f}}) {
        CHECK(turned.luminance(rotation().vector(d), 0).y ==
              doctest::Approx(still.luminance(d, 0).y).epsilon(1e-4));
        CHECK(turned.pdf(rotation().vector(d), 0) ==
              doctest::Approx(still.pdf(d, 0)).epsilon(1e-4));
    }
}

TEST_CASE("samples follow the density: chi-square") {
    CHECK(p_value(Environment::constant({1, 2, 3})) > 1e-3);
    CHECK(p_value(Environment::image(noise_image(16, 8, 3), 1, {})) > 1e-3);
    CHECK(p_value(Environment::image(noise_image(1, 1, 4), 1, {})) > 1e-3);
    CHECK(p_value(Environment::image(noise_image(2, 1, 5), 1, rotation())) > 1e-3);
    CHECK(p_value(Environment::image(noise_image(37, 5, 6), 3, rotation())) > 1e-3);
    CHECK(p_value(Environment::image(hot_image(32, 16, 5, 31, 1e4f, 0.1f), 1, {})) >
          1e-3);
    // At the zenith the density varies with azimuth: the grid has the same pole and a finer resolution.
    const Environment fan = Environment::image(hot_image(32, 16, 0, 7, 1e3f, 0), 1, {});
    CHECK(p_value(fan, 1, 200000, {Frame::from_normal({0, 1, 0}), 0.95, 1}) > 1e-3);
}

TEST_CASE("the chi-square test catches a density that is 2 % wrong") {
    const Environment e = Environment::image(noise_image(16, 8, 3), 1, {});
    CHECK(p_value(e, 1, 1000000) > 1e-3);
    CHECK(p_value(e, 1.02, 1000000) < 1e-6);
    CHECK(p_value(e, 0.98, 1000000) < 1e-6);
}

TEST_CASE("the density integrates to 1 and is positive wherever there is light") {
    for (const EnvironmentImage& image :
         {noise_image(16, 8, 8), hot_image(16, 8, 3, 0, 100, 0),
          hot_image(16, 8, 7, 9, 100, 0)}) {
        const Environment e = Environment::image(image, 1, {});
        bool covered = true;
        const double total = integrate([&](Vec3f w) {
            covered = covered && (e.pdf(w, 0) > 0 || e.luminance(w, 0).y <= 1e-4f);
            return double(e.pdf(w, 0));
        });
        CHECK(total == doctest::Approx(1).epsilon(2e-3));
        CHECK(covered);
    }
}

TEST_CASE("sample and pdf agree, and a hot texel makes no fireflies") {
    const Environment e =
        Environment::image(hot_image(64, 32, 9, 20, 1e5f, 0.01f), 1, rotation());
    const double power =
        integrate([&](Vec3f w) { return double(luminance(e.luminance(w, 0))); }, 1500);
    double sum = 0, largest = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
        const auto s =
            e.sample({float(hash_uniform(2, 2 * i)), float(hash_uniform(2, 2 * i + 1))}, 0);
        CHECK(s.pdf == doctest::Approx(e.pdf(s.direction, 0)).epsilon(3e-3));
        const double weight = luminance(e.luminance(s.direction, 0)) / s.pdf;
        sum += weight;
        largest = std::max(largest, weight);
    }
    CHECK(sum / n == doctest::Approx(power).epsilon(0.01));
    CHECK(largest < 1.3 * power);
    CHECK(e.mean_luminance() == doctest::Approx(power / (4 * kPiD)).epsilon(0.01));
}

TEST_CASE("one look finds light and density, also in a sky that turns") {
    const Environment still = Environment::image(noise_image(16, 8, 3), 2, rotation());
    const Environment turning = still.posed({{0, 1}, {{{1, 1, 1}, 0}, {{3, 2, 1}, 2}}});
    for (const Environment& e : {still, turning, Environment::constant({1, 2, 3})})
        for (int i = 0; i < 200; ++i) {
            const auto s = e.sample({float(hash_uniform(1, i)), float(hash_uniform(2, i))}, 0.25f);
            const Environment::Lookup seen = e.lookup(s.direction, 0.25f);
            CHECK(seen.luminance == e.luminance(s.direction, 0.25f));
            CHECK(seen.pdf == e.pdf(s.direction, 0.25f));
            CHECK(s.luminance > 0);
        }
}

TEST_CASE("an even sky: E = pi L, by the estimator") {
    const Environment sky = Environment::constant({0.5f, 0.5f, 0.5f});
    double sum = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const auto s = sky.sample({float((i + 0.5) / n), float(hash_uniform(1, i))}, 0);
        sum +=
            luminance(sky.luminance(s.direction, 0)) * std::max(0.f, s.direction.y) / s.pdf;
    }
    CHECK(sum / n == doctest::Approx(kPiD * 0.5).epsilon(0.005));
    CHECK(sky.mean_luminance() == doctest::Approx(0.5));
}

TEST_CASE("bad pictures are named by row and column") {
    EnvironmentImage image = noise_image(4, 2, 1);
    image.pixels[6].y = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH_AS(Environment::image(image, 1, {}),
                         doctest::Contains("row 1, column 2"), Error);
    image.pixels.pop_back();
    CHECK_THROWS_WITH_AS(Environment::image(image, 1, {}),
                         doctest::Contains("4 x 2 with 7 pixels"), Error);
    CHECK_THROWS_AS(Environment::image(noise_image(4, 2, 1), -1, {}), Error);
    CHECK_THROWS_AS(Environment::image(noise_image(4, 2, 1), 1,
                                       {{2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}}),
                    Error);
    CHECK_THROWS_AS(Environment::constant({-1, 0, 0}), Error);
}

TEST_CASE("a black picture shines nowhere") {
    const Environment e = Environment::image({4, 2, std::vector<Rgb>(8)}, 1, {});
    CHECK(e.mean_luminance() == 0);
    CHECK(e.sample({0.3f, 0.6f}, 0).pdf == 0);
    CHECK(e.pdf({0, 1, 0}, 0) == 0);
}
