// self_intersection_test.cpp -- rays that leave a closed convex mesh: inward rays always hit it again, outward rays
// never; at scales from millimetres to ten kilometres.
#include <doctest/doctest.h>

#include "scene/scene.h"
#include "scene/test_scenes.h"

using namespace dg;

namespace {

struct Failures {
    int inward = 0, outward = 0;
};

enum class Kind { flattened, crowded, moving, deforming };

/// A motion by the size of the mesh with a rotation.
Motion motion_from(const Affine3f& transform) {
    const Affine3d a = to_double(transform);
    Affine3d turn = to_matrix(Quaterniond::from_axis_angle(normalize(Vec3d{1, 2, 3}), 2.5));
    turn.origin = {1, -1, 0.5};
    return Motion::keys(std::array{0.0, 1.0}, std::array{a, a * turn}, Interpolation::decomposed);
}

/// A ball that leans over between two time steps and stays convex.
Affine3f leaning(float time) { return {{1, 0, 0}, {time, 1 + time, 0}, {0, 0, 1}, {time, 0, -time}}; }

Mesh leaning_ball() {
    Mesh mesh = ball_mesh(3);
    std::vector<Vec3f> positions;
    for (const float time : {0.f, 0.25f, 0.5f, 0.75f, 1.f})
        for (const Vec3f p : mesh.positions) positions.push_back(leaning(time).point(p));
    mesh.positions = std::move(positions);
    mesh.steps = 5;
    return mesh;
}

/// Rays from random points; `shrink` scales the error bound (1: as it is used).
Failures count_failures(const Affine3f& transform, Kind kind, float shrink, int rays) {
    SceneDescription d = describe(ball_mesh(3), GltfMaterial{});
    d.instances[0].world_from_local = transform;
    if (kind == Kind::deforming) d.meshes[0] = leaning_ball();
    if (kind == Kind::crowded) add_crowd(d);
    const Motion motion = kind == Kind::moving ? motion_from(transform) : to_double(transform);
    if (motion.moves()) d.instances[0].motion = std::make_shared<const Motion>(motion);
    d.interval = {0, 1};
    const auto scene = Scene::build(d);
    Failures failures;
    for (int i = 0; i < rays; ++i) {
        const auto time = float(hash_uniform(31, i));
        Affine3f placed = motion.moves() ? to_float(motion.at(time)) : transform;
        if (kind == Kind::deforming) placed = transform * leaning(time);
        const Vec3f outside = placed.point(test_direction(2 * i) * 2);
        Ray ray = test_ray(outside, placed.point(test_direction(2 * i) * 0.1f) - outside);
        ray.time = time;
        auto hit = scene->intersect(ray);
        if (!hit || hit->surface.instance != 0) continue;
        SurfaceHit s = hit->surface;
        s.error *= shrink;
        Vec3f wi = test_direction(2 * i + 1);
        if (i % 4 == 0) wi = normalize(wi - s.ng * (0.999f * dot(wi, s.ng)));  // grazing
        if (std::abs(dot(wi, s.ng)) < 1e-4f) continue;
        const bool inward = dot(wi, s.ng) < 0;
        const auto next = scene->intersect(spawn_ray(s, wi, time));
        const bool again = next && next->surface.instance == 0;
        if (inward) {
            failures.inward += !again || next->surface.front;
        } else {
            failures.outward += again;
        }
    }
    return failures;
}

std::vector<Affine3f> placements() {
    std::vector<Affine3f> all;
    for (float scale : {1e-3f, 1.f, 1e3f}) {
        for (float offset : {0.f, 1.f, 1e2f, 1e4f}) {
            if (offset > 3e3f * scale)
                continue;  // float spacing is coarser than the triangles
            const Vec3f o = Vec3f{0.7f, -0.5f, 0.6f} * offset;
            all.push_back({{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, o});
            all.push_back({{scale * 0.6f, scale * 0.8f, 0},
                           {-scale * 0.8f, scale * 0.6f, 0},
                           {0, 0, -2 * scale},
                           o});
        }
    }
    all.push_back({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1e4f, 0, 1e4f}});
    return all;
}

}  // namespace

TEST_CASE("no ray meets the surface that it leaves, at any scale and place") {
    for (const Kind kind : {Kind::flattened, Kind::crowded, Kind::moving, Kind::deforming}) {
        for (const Affine3f& m : placements()) {
            const Failures f = count_failures(m, kind, 1, 20000);
            CAPTURE(m.origin.x);
            CAPTURE(m.x.x);
            CAPTURE(int(kind));
            CHECK(f.inward == 0);
            CHECK(f.outward == 0);
        }
    }
}

TEST_CASE("the test sees an error bound that is too small") {
    for (const Kind kind : {Kind::flattened, Kind::moving, Kind::deforming}) {
        Failures sum;
        for (const Affine3f& m : placements()) {
            const Failures f = count_failures(m, kind, 0, 2000);
            sum.inward += f.inward;
            sum.outward += f.outward;
        }
        CHECK(sum.inward + sum.outward > 100);
    }
}
