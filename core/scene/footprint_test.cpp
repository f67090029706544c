// footprint_test.cpp -- footprints on planes and curvatures of balls against closed forms.
#include "scene/footprint.h"

#include <doctest/doctest.h>

#include "scene/test_scenes.h"

namespace dg {
namespace {

std::shared_ptr<const Scene> textured(Mesh mesh, const Affine3f& place) {
    SceneDescription d = describe(std::move(mesh), {});
    use_textures(d);
    d.instances[0].world_from_local = place;
    return Scene::build(std::move(d));
}

Affine3f scaled(float x, float y, float z) {
    return {{x, 0, 0}, {0, y, 0}, {0, 0, z}, {0, 0, 0}};
}

}  // namespace

TEST_CASE("the footprint on a plane: the cone's width across, 1 / cos of it along the way") {
    // A quad of 6 m x 2 m has uv from 0 to 1: 1/6 and 1/2 of uv per metre.
    const auto scene = textured(quad_mesh(), scaled(3, 1, 1));
    const float slant = 0.6f;  // sine
    Ray ray = test_ray({0.3f - slant * 5, 0.2f, 0.8f * 5}, {slant, 0, -0.8f});
    ray.cone = {0.01f, 0.002f};
    const auto hit = scene->intersect(ray);
    REQUIRE(hit);
    const float width = 0.01f + 0.002f * 5;
    const UvFootprint f = hit->surface.footprint[0];
    CHECK(length(f.across) == doctest::Approx(width / 2));
    CHECK(std::abs(f.across.x) < 1e-6f);
    CHECK(length(f.along) == doctest::Approx(width / 0.8 / 6));
    CHECK(std::abs(f.along.y) < 1e-6f);
    ray.cone = {};
    CHECK(length(scene->intersect(ray)->surface.footprint[0].along) == 0);
}

TEST_CASE("curvature: 1 / R outside of a ball, -1 / R inside, 0 on a plane") {
    Mesh ball = ball_mesh(3);
    ball.normals = ball.positions;
    for (const float mirror : {1.f, -1.f}) {
        const auto scene = textured(ball, scaled(2 * mirror, 2, 2));
        const auto outside = scene->intersect(test_ray({0.1f, 0.3f, 9}, {0, 0, -1}));
        REQUIRE(outside);
        CHECK(scene->curvature(outside->surface) == doctest::Approx(0.5).epsilon(1e-4));
        const auto inside = scene->intersect(test_ray({0.1f, 0.3f, 0}, {0, 0, 1}));
        REQUIRE(inside);
        CHECK(scene->curvature(inside->surface) == doctest::Approx(-0.5).epsilon(1e-4));
    }
    const auto flat = textured(quad_mesh(), {});
    CHECK(flat->curvature(flat->intersect(test_ray({0, 0, 1}, {0, 0, -1}))->surface) == 0);
}

}  // namespace dg
