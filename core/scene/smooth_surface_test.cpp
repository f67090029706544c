// Points lifted to the smooth surface of a mesh with vertex normals.
#include "scene/smooth_surface.h"

#include <doctest/doctest.h>

#include "scene/scene.h"
#include "scene/test_scenes.h"

using namespace dg;

namespace {

const Wavelengths kWavelengths = Wavelengths::sample(0.5f);

Mesh smooth_ball(int levels) {
    Mesh mesh = ball_mesh(levels);
    mesh.normals = mesh.positions;
    return mesh;
}

/// The hit of a ray as a camera path shades it.
SurfaceHit shaded(const Scene& scene, const Ray& ray) {
    const auto found = scene.intersect(ray);
    REQUIRE(found);
    SurfaceHit hit = found->surface;
    const MaterialAt material = scene.material(hit);
    scene.shade_smooth(material, hit, kWavelengths);
    return hit;
}

/// A ray from outside to the center of a placed unit ball, or from the center outward.
Ray ray_through(const Affine3f& placed, Vec3f direction, bool from_inside) {
    const Vec3f outside = placed.point(direction * 3), center = placed.origin;
    return from_inside ? test_ray(center, outside - center) : test_ray(outside, center - outside);
}

}  // namespace

TEST_CASE("a lifted point is on the ball, at any scale") {
    const Affine3f turned{{0.6f, 0.8f, 0}, {-0.8f, 0.6f, 0}, {0, 0, 1}, {3, -2, 1}};
    for (const float scale : {0.01f, 1.f, -5.f}) {   // negative: mirrored
        const Affine3f placed{turned.x * scale, turned.y * scale, turned.z * scale, turned.origin};
        SceneDescription d = describe(smooth_ball(2), GltfMaterial{});
        d.instances[0].world_from_local = placed;
        const auto scene = Scene::build(d);
        for (int i = 0; i < 300; ++i) {
            const SurfaceHit hit = shaded(*scene, ray_through(placed, test_direction(i), false));
            CHECK(hit.smooth);
            const float low = length(scene->met(hit) - placed.origin) / std::abs(scale);
            const float high = length(hit.position - placed.origin) / std::abs(scale);
            CHECK(std::abs(high - 1) < 0.15f * (1 - low) + 2e-5f);
            CHECK(dot(hit.ng, hit.wo) > 0);
            CHECK(length(hit.ng - normalize(scene->met(hit) - placed.origin)) < 0.03f);
        }
    }
}

TEST_CASE("seen from inside, a ball is concave and has no lift") {
    const auto scene = Scene::build(describe(smooth_ball(2), GltfMaterial{}));
    for (int i = 0; i < 300; ++i) {
        const SurfaceHit hit = shaded(*scene, ray_through({}, test_direction(i), true));
        CHECK(scene->met(hit) == hit.position);
    }
}

TEST_CASE("a deforming ball is lifted to its place at the time") {
    Mesh mesh = smooth_ball(2);
    const std::size_t n = mesh.positions.size();
    std::vector<Vec3f> positions(mesh.positions.begin(), mesh.positions.end()), normals = positions;
    for (std::size_t i = 0; i < n; ++i) {
        positions.push_back(positions[i] * 2);
        normals.push_back(normals[i]);
    }
    mesh.positions = positions, mesh.normals = normals, mesh.steps = 2;
    const auto scene = Scene::build(describe(mesh, GltfMaterial{}));
    for (int i = 0; i < 100; ++i) {
        Ray ray = test_ray(test_direction(i) * 6, -test_direction(i));
        ray.time = 0.5f;
        const SurfaceHit hit = shaded(*scene, ray);
        CHECK(std::abs(length(hit.position) - 1.5f) < 0.15f * (1.5f - length(scene->met(hit))) + 2e-5f);
    }
}

TEST_CASE("flat triangles and materials that transmit light keep their triangle") {
    Mesh flat = ball_mesh(1);
    std::vector<Vec3f> positions, normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& t : flat.triangles) {
        const auto first = std::uint32_t(positions.size());
        const Vec3f a = flat.positions[t[0]], b = flat.positions[t[1]], c = flat.positions[t[2]];
        positions.insert(positions.end(), {a, b, c});
        normals.insert(normals.end(), 3, normalize(cross(b - a, c - a)));
        triangles.push_back({first, first + 1, first + 2});
    }
    flat.positions = positions, flat.normals = normals, flat.triangles = triangles;
    GltfMaterial glass;
    glass.transmission = 1;
    for (const auto& d : {describe(flat, GltfMaterial{}), describe(smooth_ball(1), glass)}) {
        const auto scene = Scene::build(d);
        for (int i = 0; i < 50; ++i) {
            const SurfaceHit hit = shaded(*scene, ray_through({}, test_direction(i), false));
            CHECK(!hit.smooth);
            CHECK(scene->met(hit) == hit.position);
        }
    }
}

TEST_CASE("no lift passes another surface") {
    // A sheet just outside a triangle, within its lift.
    Mesh ball = smooth_ball(1);
    const auto t = ball.triangles[0];
    const Vec3f middle = (ball.positions[t[0]] + ball.positions[t[1]] + ball.positions[t[2]]) * (1.f / 3);
    const Vec3f n = normalize(middle);
    const Frame frame = Frame::from_normal(n);
    for (const bool covered : {false, true}) {
        SceneDescription d = describe(ball, GltfMaterial{});
        if (covered) {
            add(d, quad_mesh(), {"sheet", GltfMaterial{}});
            d.instances.back().world_from_local = {frame.x, frame.y, n, n * (length(middle) + 0.01f)};
        }
        const auto scene = Scene::build(d);
        const SurfaceHit hit = shaded(*scene, test_ray(n * (length(middle) + 0.005f), -n));
        CHECK(hit.instance == 0);
        CHECK((length(hit.position - scene->met(hit)) > 0.05f) == !covered);
    }
}
