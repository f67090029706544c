// Ideal cameras: directions, focus, sampling of the iris, and pixel coordinates.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "math/hash.h"
#include "math/statistics.h"

namespace dg {
namespace {

std::vector<CameraRay> draw(const LensKind& lens, Vec2f film_mm, int n) {
    std::vector<CameraSample> samples(n);
    for (int i = 0; i < n; ++i)
        samples[i] = {film_mm, {float(hash_uniform(1, i)), float(hash_uniform(2, i))}, 0.25f, 550};
    std::vector<CameraRay> rays(n);
    generate_rays({Affine3d{}, lens}, samples, rays);
    return rays;
}

/// p-value of a chi-square test that origins are uniform on the iris, in polar cells of equal area.
double iris_p_value(const ThinLens& lens, double swap) {
    std::vector<double> observed(64), expected;
    const int n = 100000;
    for (const CameraRay& r : draw(lens, {3, 4}, n)) {
        const double radius = lens.aperture_radius_mm * 1e-3;
        const double x = r.ray.origin.x / radius, y = r.ray.origin.y / radius;
        const int ring = std::min(7, int(8 * std::pow(x * x + y * y, swap)));
        const int sector = std::min(7, int(8 * (std::atan2(y, x) / (2 * kPiD) + 0.5)));
        observed[8 * ring + sector] += 1;
    }
    expected.assign(64, n / 64.0);
    return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("a pinhole sends every ray through its centre, upright") {
    for (const CameraRay& r : draw(Pinhole{50, false}, {18, 12}, 4)) {
        CHECK(length(r.ray.origin) == 0);
        CHECK(r.ray.direction.x / -r.ray.direction.z == doctest::Approx(18.0 / 50));
        CHECK(r.ray.direction.y / -r.ray.direction.z == doctest::Approx(12.0 / 50));
        CHECK(r.weight == 1);
        CHECK(r.ray.time == 0.25f);
    }
    const double cosine = 50 / std::sqrt(50 * 50 + 18 * 18 + 12 * 12.0);
    CHECK(draw(Pinhole{50, true}, {18, 12}, 1)[0].weight == doctest::Approx(std::pow(cosine, 4)));
}

TEST_CASE("all rays of a thin lens meet in the plane of focus") {
    for (const double focus : {0.3, 2.0, 1e3}) {
        ThinLens lens{50, 12.5, focus, {}, false};
        for (const CameraRay& r : draw(lens, {10, -7}, 100)) {
            const float t = float((-focus - r.ray.origin.z) / r.ray.direction.z);
            const Vec3f p = r.ray.origin + r.ray.direction * t;
            CHECK(p.x == doctest::Approx(focus * 10 / 50).epsilon(1e-4));
            CHECK(p.y == doctest::Approx(-focus * 7 / 50).epsilon(1e-4));
            CHECK(length(r.ray.origin) <= 0.0125f * 1.00001f);
        }
    }
    ThinLens far{50, 12.5, std::numeric_limits<double>::infinity(), {}, false};
    const auto rays = draw(far, {10, -7}, 50);
    for (const CameraRay& r : rays) CHECK(length(r.ray.direction - rays[0].ray.direction) < 1e-6f);
}

TEST_CASE("the iris of a thin lens is filled evenly") {
    const ThinLens lens{50, 12.5, 2, {}, false};
    CHECK(iris_p_value(lens, 1.0) > 1e-3);
    CHECK(iris_p_value(lens, 0.97) < 1e-6);   // the test detects rings of slightly unequal areas
}

TEST_CASE("the mean weight does not depend on the shape of the iris") {
    std::vector<float> star(64 * 64, 0);
    for (int i = 0; i < 64; ++i) star[64 * 32 + i] = star[64 * i + 32] = 1;
    for (const Iris& iris : {Iris(), Iris::polygon(5, 10, 0), Iris::polygon(6, 0, -0.5),
                             Iris::polygon(7, 0, 1), Iris::image(64, 64, star)}) {
        double sum = 0;
        for (const CameraRay& r : draw(ThinLens{50, 12.5, 2, iris, false}, {0, 0}, 200000)) sum += r.weight;
        CHECK(sum / 200000 == doctest::Approx(1).epsilon(0.01));
    }
}

TEST_CASE("pixels and film: top left, upright, and back") {
    const Sensor sensor{36, 24, 36, 24, {2, -1}};
    CHECK(sensor.mm_from_px(Vec2f{0, 0}).x == doctest::Approx(-16));
    CHECK(sensor.mm_from_px(Vec2f{0, 0}).y == doctest::Approx(11));
    CHECK(sensor.mm_from_px(Vec2f{36, 24}).y == doctest::Approx(-13));
    const Vec2f px = sensor.px_from_mm(sensor.mm_from_px(Vec2f{7.25f, 19.5f}));
    CHECK(px.x == doctest::Approx(7.25));
    CHECK(px.y == doctest::Approx(19.5));
}

TEST_CASE("the camera's place and turn reach the ray") {
    Camera camera{Affine3d{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {1, 2, 3}}, Pinhole{}};
    Ray ray;
    ray.origin = {0.1f, 0, 0};
    ray.direction = {0, 0, -1};
    const Ray world = to_world(camera, ray);
    CHECK(length(world.origin - Vec3f{1, 2, 2.9f}) < 1e-6f);
    CHECK(length(world.direction - Vec3f{-1, 0, 0}) < 1e-6f);
}

TEST_CASE("a ray starts where the camera is at its time") {
    const Affine3d turned{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {4, 0, 0}};
    const double times[] = {0, 1};
    const Affine3d keys[] = {{}, turned};
    const Camera camera{Motion::keys(times, keys, Interpolation::decomposed), Pinhole{}};
    Ray ray;
    ray.direction = {0, 0, -1};
    for (const float t : {0.f, 0.25f, 0.5f, 1.f}) {
        ray.time = t;
        const float angle = t * float(kPiD) / 2;
        const Ray world = to_world(camera, ray);
        CHECK(length(world.origin - Vec3f{4 * t, 0, 0}) < 1e-6f);
        CHECK(length(world.direction - Vec3f{-std::sin(angle), 0, -std::cos(angle)}) < 1e-6f);
        CHECK(world.time == t);
    }
}

TEST_CASE("a leaf shutter takes an even part of the thin lens's iris, and the light of its area") {
    const ThinLens lens{50, 12.5, 2, Iris::polygon(5, 10, 0.2), false};
    for (const float a : {0.f, 0.3f, 0.8f, 1.f}) {
        double weight = 0, whole = 0;
        for (int i = 0; i < 200; ++i) {
            CameraSample s{{3, 4}, {float(hash_uniform(1, i)), float(hash_uniform(2, i))}, 0, 550};
            CameraRay open, leaf;
            lens.generate({&s, 1}, {&open, 1});
            s.iris_opening = a;
            lens.generate({&s, 1}, {&leaf, 1});
            CHECK(length(leaf.ray.origin - open.ray.origin * a) < 1e-8f);
            CHECK(leaf.weight == doctest::Approx(a * a * open.weight));
            weight += leaf.weight, whole += open.weight;
            Pinhole{}.generate({&s, 1}, {&leaf, 1});
            CHECK(leaf.weight == doctest::Approx(a * a));
        }
        CHECK(weight / whole == doctest::Approx(a * a));
    }
}

}  // namespace dg
