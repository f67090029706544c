// pixel_cone_test.cpp -- angles of pixels against closed forms and traced rays.
#include "camera/inverse/pixel_cone.h"

#include <doctest/doctest.h>

#include "optics/lens/test_lenses.h"

namespace dg {
namespace {

using test::check_lens;
using test::fisheye;
using test::wide_angle;

const Sensor kSensor{.width = 360, .height = 240};

ExactLensSettings at_stop(double f_stop) {
    ExactLensSettings settings;
    settings.f_stop = f_stop;
    return settings;
}

/// Angle between rays from film points a tenth of a pixel apart, per pixel.
double traced(const ExactLens& lens, Vec2f film_mm, Vec2f direction) {
    const float step = 0.01f;
    CameraSample samples[2] = {{film_mm, {0.5f, 0.5f}, 0, 587.56f},
                               {film_mm + direction * step, {0.5f, 0.5f}, 0, 587.56f}};
    CameraRay rays[2];
    lens.generate(samples, rays);
    REQUIRE(rays[0].weight > 0);
    return length(rays[1].ray.direction - rays[0].ray.direction) / step * 0.1;
}

}  // namespace

TEST_CASE("a pinhole's pixel covers pitch / f on the axis, cos^1.5 of that beside it") {
    const PixelCone cone({{}, Pinhole{35}}, kSensor);
    for (const float r : {0.f, 5.f, 12.f, 20.f}) {
        const double expected = 0.1 / 35 * std::pow(1 + r * r / (35 * 35), -0.75);
        CHECK(cone.angle({0, -r}) / expected == doctest::Approx(1).epsilon(0.002));
    }
    ThinLens thin;
    thin.film_distance_mm = 35;
    CHECK(PixelCone({{}, thin}, kSensor).angle({3, 4}) == cone.angle({5, 0}));
    const RayCone start = cone.at({0, 0}, {.origin = {}, .direction = {0, 0, -1}});
    CHECK(start.width == 0);
    CHECK(start.spread / (kConeShare * 0.1 / 35) == doctest::Approx(1).epsilon(0.001));
    CHECK(PixelCone().at({1, 2}, {.origin = {}, .direction = {0, 0, -1}}).empty());
}

TEST_CASE("an exact lens's pixel covers what two rays through the iris's centre say") {
    for (const Prescription& p : {check_lens(), wide_angle(), fisheye()}) {
        const ExactLens lens(p, at_stop(11));
        const PixelCone cone({{}, lens}, kSensor);
        for (const float r : {2.f, 8.f}) {
            const double area = traced(lens, {r, 0}, {1, 0}) * traced(lens, {r, 0}, {0, 1});
            CHECK(cone.angle({r, 0}) / std::sqrt(area) == doctest::Approx(1).epsilon(0.01));
        }
        for (const float r : {19.f, 21.6f}) {  // also beyond the image circle
            CHECK(cone.angle({0, r}) >= 0);
            CHECK(cone.angle({0, r}) < 2 * cone.angle({0, 0}));
        }
    }
}

TEST_CASE("the cone of an exact lens has its apex on the entrance pupil") {
    const ExactLens lens(check_lens(), at_stop(8));
    const PixelCone cone({{}, lens}, kSensor);
    const Vec3f from{0, 0, -0.02f};  // 20 mm in front of the pupil
    const RayCone start = cone.at({0, 0}, {.origin = from, .direction = {0, 0, -1}});
    CHECK(start.width / start.spread == doctest::Approx(0.02));
}

}  // namespace dg
