// motion_test.cpp -- moving instances: what a ray meets is what it would meet in the still scene of
// its time.
#include <doctest/doctest.h>

#include "scene/scene.h"
#include "scene/test_scenes.h"

namespace dg {
namespace {

Affine3d turned(Vec3d axis, double degrees, double scale, Vec3d origin) {
    Affine3d m = to_matrix(Quaterniond::from_axis_angle(normalize(axis), degrees * kPiD / 180));
    m = {m.x * scale, m.y * scale, m.z * scale, origin};
    return m;
}

Motion between(const Affine3d& a, const Affine3d& b, Interpolation how = Interpolation::decomposed) {
    const std::array times{2.0, 4.0};  // s
    const std::array keys{a, b};
    return Motion::keys(times, keys, how);
}

/// Mirrored and sheared: no rotation describes it.
Affine3d crooked() {
    Affine3d m = turned({1, 2, 3}, 70, 0.8, {0.5, -0.2, 0.3});
    m.x = m.x * -1.3 + m.y * 0.4;
    return m;
}

std::vector<Motion> motions() {
    const Affine3d one{}, far = turned({0, 1, 0.2}, 170, 1.2, {4, 1, -2});
    const Affine3d turn = turned({0, 1, 0}, 170, 1, {0, 3, 0});
    return {between(one, far),
            between(one, far, Interpolation::linear),
            between(one, turn, Interpolation::twist),
            between(one, far, Interpolation::slerp),
            between(crooked(), turn * crooked()),
            Motion(far).spinning({{0, 1, 0}, 1.6, {0.5, 0, 0}, 1}),
            between(one, far).spinning({{1, 0, 0}, 7, {0, 0, 0}, 0}),
            between(turned({0, 0, 1}, 0, 0.05, {30, 0, 15}), turned({0, 1, 1}, 60, 0.05, {30, 0, 15}))};
}

SceneDescription moving_ball(const Motion& motion) {
    SceneDescription d = describe(ball_mesh(3), GltfMaterial{});
    d.meshes[0].normals = d.meshes[0].positions;
    d.instances[0].motion = std::make_shared<const Motion>(motion);
    d.interval = {2, 4};
    return d;
}

SceneDescription still_ball(const Motion& motion, double seconds) {
    SceneDescription d = moving_ball(motion);
    d.instances[0].motion = nullptr;
    d.instances[0].world_from_local = to_float(motion.at(seconds));
    return d;
}

/// From outside the ball of radius 2 to near its centre, at a time.
Ray ray_to(const Affine3d& m, int i, float time) {
    const Vec3d from = m.point(to_double(test_direction(3 * i)) * 2.5);
    const Vec3d to = m.point(to_double(test_direction(3 * i + 1)) * 0.97);
    Ray ray = test_ray(to_float(from), to_float(normalize(to - from)));
    ray.time = time;
    return ray;
}

bool blocked(const Scene& scene, const Ray& ray, float distance) {
    return scene.visibility(ray, distance, false, {}, Wavelengths::sample(0.5f)).is_black();
}

}  // namespace

TEST_CASE("a moving instance is met where it stands at the time of the ray") {
    for (const Motion& motion : motions()) {
        const auto moving = Scene::build(moving_ball(motion));
        for (int k = 0; k <= 16; ++k) {
            const float time = float(k) / 16;
            const Affine3d m = motion.at(2 + 2 * double(time));
            const auto still = Scene::build(still_ball(motion, 2 + 2 * double(time)));
            int different = 0;
            for (int i = 0; i < 200; ++i) {
                const Ray ray = ray_to(m, i, time);
                const auto a = moving->intersect(ray), b = still->intersect(ray);
                if (!a || !b) {
                    different += a.has_value() != b.has_value();
                    continue;
                }
                const float size = b->surface.t;
                if (length(a->surface.position - b->surface.position) > 1e-4f * size + 1e-6f * length(b->surface.position) ||
                    dot(a->surface.ng, b->surface.ng) < 0.9999f ||
                    dot(a->surface.ns, b->surface.ns) < 0.9999f)
                    ++different;
                CHECK(a->surface.front == b->surface.front);
                CHECK(a->surface.time == time);
                const float c = b->surface.front ? 1.f : -1.f;
                CHECK(moving->curvature(a->surface) * c > 0);
                CHECK(blocked(*moving, ray, size * 1.1f));
                CHECK_FALSE(blocked(*moving, ray, size * 0.9f));
            }
            CAPTURE(k);
            CHECK(different <= 2);  // rounding at silhouettes and edges
        }
    }
}

TEST_CASE("the bounds of a scene hold what moves at every time") {
    for (const Motion& motion : motions()) {
        const auto scene = Scene::build(moving_ball(motion));
        const auto bounds = scene->bounds();
        for (int i = 0; i < 3000; ++i) {
            const double t = 2 + 2 * hash_uniform(5, i);
            const Vec3d p = motion.at(t).point(to_double(test_direction(i)) * 0.95);
            for (int k = 0; k < 3; ++k) {
                CHECK(p[k] >= bounds.min[k]);
                CHECK(p[k] <= bounds.max[k]);
            }
        }
    }
}

TEST_CASE("an instance is met only while it is shown") {
    SceneDescription d = describe(quad_mesh(), GltfMaterial{});
    d.interval = {10, 20};
    d.instances[0].shown =
        std::make_shared<const Shown>(Shown{{{0, 12}, {15, 16}, {19, 30}}});
    const auto scene = Scene::build(d);
    for (int i = 0; i < 1000; ++i) {
        Ray ray = test_ray({0.1f, 0.2f, 2}, {0, 0, -1});
        ray.time = float(i) / 999;
        const double s = 10 + 10 * double(ray.time);
        const bool there = s < 12 || (s >= 15 && s < 16) || s >= 19;
        CHECK(scene->intersect(ray).has_value() == there);
        CHECK(blocked(*scene, ray, 9) == there);
    }
    d.instances[0].shown = std::make_shared<const Shown>(Shown{{{0, 5}}});
    CHECK_FALSE(Scene::build(d)->intersect(test_ray({0.1f, 0.2f, 2}, {0, 0, -1})));
    d.interval = {3, 3};
    CHECK(Scene::build(d)->intersect(test_ray({0.1f, 0.2f, 2}, {0, 0, -1})));
}

TEST_CASE("what has no extent at a time is not there then") {
    Affine3d nothing{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {}};
    SceneDescription d = describe(quad_mesh(), GltfMaterial{});
    d.instances[0].motion = std::make_shared<const Motion>(between(nothing, {}));
    d.interval = {2, 4};
    const auto grows = Scene::build(d);
    Ray ray = test_ray({0.3f, 0.2f, 2}, {0, 0, -1});
    for (const auto& [time, there] : {std::pair{0.f, false}, {0.2f, false}, {0.4f, true}, {1.f, true}}) {
        ray.time = time;
        CHECK(grows->intersect(ray).has_value() == there);
    }
    d.interval = {1, 2};
    CHECK_FALSE(Scene::build(d)->intersect(ray));
}

}  // namespace dg
