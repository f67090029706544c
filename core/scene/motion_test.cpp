// motion_test.cpp -- moving instances: rays have the same hits as in a static scene of their time.
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

/// A mirrored and sheared transform.
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

/// Ray at a time from outside the ball of radius 2 toward its center.
Ray ray_to(const Affine3d& m, int i, float time) {
    const Vec3d from = m.point(to_double(test_direction(3 * i)) * 2.5);
    const Vec3d to = m.point(to_double(test_direction(3 * i + 1)) * 0.97);
    Ray ray = test_ray(to_float(from), to_float(normalize(to - from)));
    ray.time = time;
    return ray;
}

bool blocked(const Scene& scene, Ray ray, float distance) {
    ray.t_max = distance;
    return scene.visibility(ray, false, {}, Wavelengths::sample(0.5f)).is_black();
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

namespace {

/// A ball that bulges and leans, at equal time steps, with arbitrary normals.
SceneDescription deforming_ball(std::uint32_t steps) {
    SceneDescription d = describe(ball_mesh(3), GltfMaterial{});
    Mesh& mesh = d.meshes[0];
    std::vector<Vec3f> positions, normals;
    for (std::uint32_t k = 0; k < steps; ++k) {
        const float s = float(k) / float(steps - 1), swell = 1 + s * s;
        for (const Vec3f p : mesh.positions) {
            positions.push_back({p.x * swell + 2 * s * p.y + 5 * s, p.y / swell, p.z + s});
            normals.push_back(normalize(Vec3f{p.x / swell, p.y * swell - 2 * s * p.x, p.z}));
        }
    }
    mesh.positions = std::move(positions);
    mesh.normals = std::move(normals);
    mesh.steps = steps;
    d.interval = {2, 4};
    return d;
}

/// The static mesh at a time, interpolated between steps.
SceneDescription frozen(const SceneDescription& moving, float time) {
    SceneDescription d = moving;
    Mesh& mesh = d.meshes[0];
    const std::size_t n = mesh.vertex_count();
    const float along = time * float(mesh.steps - 1);
    const std::size_t step = std::min(std::size_t(along), std::size_t(mesh.steps - 2));
    const float s = along - float(step);
    std::vector<Vec3f> positions, normals;
    for (std::size_t i = step * n; i < (step + 1) * n; ++i) {
        positions.push_back(mesh.positions[i] * (1 - s) + mesh.positions[i + n] * s);
        normals.push_back(normalize(mesh.normals[i] * (1 - s) + mesh.normals[i + n] * s));
    }
    mesh.positions = std::move(positions);
    mesh.normals = std::move(normals);
    mesh.steps = 1;
    for (Instance& instance : d.instances) {
        if (!instance.motion) continue;
        instance.world_from_local = to_float(instance.motion->at(2 + 2 * double(time)));
        instance.motion = nullptr;
    }
    return d;
}

}  // namespace

TEST_CASE("a mesh that deforms is met in its shape at the time of the ray") {
    const Motion flight = between({}, turned({0, 1, 0.2}, 100, 1.2, {1, 1, -2}));
    for (const std::uint32_t steps : {2u, 3u, 9u, kMostMeshSteps}) {
        for (const int kind : {0, 1, 2}) {  // flattened, instanced, moving
            SceneDescription d = deforming_ball(steps);
            d.instances[0].world_from_local = to_float(turned({1, 0, 0}, 40, 2, {0, 1, 0}));
            if (kind == 1) add_crowd(d);
            if (kind == 2) d.instances[0].motion = std::make_shared<const Motion>(flight);
            const auto moving = Scene::build(d);
            d.instances.resize(1);
            int different = 0, met = 0;
            for (int k = 0; k < 12; ++k) {
                const float time = k == 11 ? 1.f : float(hash_uniform(3, k));
                const SceneDescription then = frozen(d, time);
                const auto still = Scene::build(then);
                const Affine3f m = then.instances[0].world_from_local;
                const auto& p = then.meshes[0].positions;
                for (int i = 0; i < 100; ++i) {
                    const auto share = float(hash_uniform(4, i));
                    const Vec3f to = m.point(p[i % p.size()] * share + p[(7 * i) % p.size()] * (1 - share));
                    Ray ray = test_ray(to + test_direction(i) * 8.f, test_direction(i) * -1.f);
                    ray.time = time;
                    const auto a = moving->intersect(ray), b = still->intersect(ray);
                    met += a.has_value();
                    different += a.has_value() != b.has_value();
                    if (!a || !b) continue;
                    different += length(a->surface.position - b->surface.position) > 1e-4f ||
                                 (a->surface.primitive == b->surface.primitive &&
                                  dot(a->surface.ng, b->surface.ng) < 0.9999f) ||
                                 dot(a->surface.ns, b->surface.ns) < 0.9999f;
                }
            }
            CAPTURE(steps);
            CAPTURE(kind);
            CHECK(met > 400);
            CHECK(different <= 3);
        }
    }
}

TEST_CASE("normals of vertices are unit vectors between steps, and tangents turn between them") {
    GltfMaterial brushed;
    brushed.anisotropy.strength = 1;
    SceneDescription d = describe(quad_mesh(), brushed);
    Mesh& mesh = d.meshes[0];
    const std::size_t n = mesh.positions.size();
    // Some vertices turn by 90 degrees, the others stay.
    std::vector<Vec3f> positions, normals(2 * n, {0, 0, 1});
    normals[n] = normals[n + 1] = normalize(Vec3f{1, 0, 1e-3f});
    std::vector<std::array<float, 4>> tangents(2 * n, {0, 1, 0, 1});
    for (std::size_t i = 0; i < 2 * n; ++i) {
        positions.push_back(mesh.positions[i % n]);
        if (i >= n) tangents[i] = {1, 0, 0, 1};
    }
    mesh.positions = std::move(positions);
    mesh.normals = std::move(normals);
    mesh.tangents = std::move(tangents);
    mesh.steps = 2;
    d.interval = {2, 4};
    const auto moving = Scene::build(d);
    for (const float time : {0.f, 0.25f, 0.5f, 0.8f, 1.f}) {
        CAPTURE(time);
        SceneDescription then = frozen(d, time);
        const float to_x = time, to_y = 1 - time;
        then.meshes[0].tangents = std::vector<std::array<float, 4>>(n, {to_x, to_y, 0, 1});
        const auto still = Scene::build(then);
        for (const Vec3f from : {Vec3f{0.3f, 0.1f, 7}, Vec3f{-0.5f, 0.6f, 7}}) {
            Ray ray = test_ray(from, {0, 0, -1});
            ray.time = time;
            const SurfaceHit a = moving->intersect(ray)->surface, b = still->intersect(ray)->surface;
            CHECK(length(a.ns - b.ns) < 1e-5f);
            CHECK(length(a.tangent - b.tangent) < 1e-5f);
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
    d.instances[0].shown = std::make_shared<const Shown>(Shown{{{3, 3}}});  // shown for an instant
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
