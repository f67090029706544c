// curve_surface_test.cpp -- curves in a scene: rays that leave them, texture coordinates, colours, footprints, frames,
// bounds.
#include <doctest/doctest.h>

#include "geometry/curves.h"
#include "scene/scene.h"
#include "scene/test_scenes.h"

using namespace dg;

namespace {

using Points = std::vector<std::array<float, 4>>;  // x, y, z, radius

Mesh curves_mesh(bool cubic, const Points& points, std::vector<std::uint32_t> ends) {
    Mesh mesh;
    mesh.name = "curves";
    mesh.curves.cubic = cubic;
    std::vector<Vec3f> positions;
    std::vector<float> radii;
    std::vector<std::uint32_t> starts;
    for (const auto& p : points) positions.push_back({p[0], p[1], p[2]}), radii.push_back(p[3]);
    std::uint32_t start = 0;
    for (const std::uint32_t end : ends) {
        for (; starts.size() < end; start += cubic ? 3 : 1) starts.push_back(start);
        ++start;
    }
    mesh.positions = std::move(positions);
    mesh.curves.radii = std::move(radii);
    mesh.curves.starts = std::move(starts);
    mesh.curves.ends = std::move(ends);
    return mesh;
}

/// A parabola from (0, 0, 0) to (1, 0, 0) that is curved toward +y; exact with cubic segments.
Points bow(int segments, bool cubic, float radius, float taper, float bend) {
    Points points;
    const auto add = [&](double x, double y) {
        points.push_back({float(x), float(y), 0, radius * (1 - taper * float(x))});
    };
    const double step = 1.0 / segments;
    for (int i = 0; i < segments; ++i) {
        const double x = i * step, y = bend * x * (1 - x), slope = bend * (1 - 2 * x);
        const double x1 = x + step, y1 = bend * x1 * (1 - x1), slope1 = bend * (1 - 2 * x1);
        add(x, y);
        if (!cubic) continue;
        add(x + step / 3, y + slope * step / 3);
        add(x1 - step / 3, y1 - slope1 * step / 3);
    }
    add(1, 0);
    return points;
}

struct Failures {
    int inward = 0, outward = 0, met = 0;
};

/// Rays that leave a curve, as in self_intersection_test.cpp. A straight curve is convex; on a bent curve only hits
/// that are too close count as errors.
Failures count_failures(const Mesh& mesh, const Affine3f& placed, bool moving, float shrink, int rays) {
    SceneDescription d = describe(mesh, GltfMaterial{});
    d.instances[0].world_from_local = placed;
    Affine3d turn = to_matrix(Quaterniond::from_axis_angle(normalize(Vec3d{1, 2, 3}), 2.5));
    const Affine3d still = to_double(placed);
    const Motion motion = moving ? Motion::keys(std::array{0.0, 1.0}, std::array{still, still * turn},
                                                Interpolation::decomposed)
                                 : Motion(still);
    if (moving) d.instances[0].motion = std::make_shared<const Motion>(motion);
    d.interval = {0, 1};
    const auto scene = Scene::build(d);
    const Mesh& made = scene->description().meshes[0];
    Failures failures;
    for (int i = 0; i < rays; ++i) {
        const auto time = float(hash_uniform(31, i));
        const Affine3d now = motion.moves() ? motion.at(time) : still;
        const CurveSegment s = segment_at(made, std::uint32_t(i) % std::uint32_t(made.curves.starts.size()), 0);
        const double u = hash_uniform(32, i), r = s.radius(u);
        const Vec3d target = s.center(u) + to_double(test_direction(3 * i)) * (0.9 * r * hash_uniform(33, i));
        const Vec3d from = target + to_double(test_direction(3 * i + 1)) * (3 * r);
        Ray ray = test_ray(to_float(now.point(from)), to_float(now.vector(target - from)));
        ray.time = time;
        const auto hit = scene->intersect(ray);
        if (!hit) continue;
        SurfaceHit surface = hit->surface;
        surface.error *= shrink;
        ++failures.met;
        Vec3f wi = test_direction(3 * i + 2);
        if (i % 4 == 0) wi = normalize(wi - surface.ng * (0.99f * dot(wi, surface.ng)));  // grazing
        const float cosine = dot(wi, surface.ng);
        // A ray that enters at so flat an angle leaves before Embree can separate both hits.
        if (std::abs(cosine) < (cosine < 0 ? 0.03f : 3e-3f)) continue;
        const auto next = scene->intersect(spawn_ray(surface, wi, time));
        const double near = 0.05 * std::abs(double(cosine)) * r * length(now.x);
        if (cosine < 0) {
            failures.inward += !next || next->surface.front;
        } else {
            failures.outward += next && double(next->surface.t) < near;
        }
    }
    return failures;
}

std::vector<Affine3f> placements() {
    std::vector<Affine3f> all;
    for (const float scale : {1e-3f, 1.f, 1e3f})
        for (const float offset : {0.f, 1.f, 1e2f}) {
            if (offset > 1e2f * scale) continue;
            const Vec3f o = Vec3f{0.7f, -0.5f, 0.6f} * offset;
            all.push_back({{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, o});
            all.push_back({{scale * 0.6f, scale * 0.8f, 0}, {-scale * 0.8f, scale * 0.6f, 0}, {0, 0, -2 * scale}, o});
        }
    return all;
}

struct Shape {
    bool cubic;
    int segments;
    float radius, taper, bend;
};
constexpr Shape kShapes[] = {{true, 1, 0.1f, 0, 0},        {true, 4, 0.02f, 0.9f, 0}, {true, 4, 0.005f, 0.5f, 0.5f},
                             {true, 1, 0.002f, 0, 0.5f},   {true, 3, 0.1f, 0.5f, 1},  {false, 1, 0.1f, 0, 0},
                             {false, 3, 0.01f, 0.9f, 0},   {false, 1, 0.002f, 0, 0}};

Failures sum_of_failures(float shrink, int rays, bool show) {
    Failures sum;
    for (const Shape& shape : kShapes)
        for (const bool moving : {false, true})
            for (const Affine3f& m : placements()) {
                const Points points = bow(shape.segments, shape.cubic, shape.radius, shape.taper, shape.bend);
                const Mesh mesh = curves_mesh(shape.cubic, points, {std::uint32_t(shape.segments)});
                const Failures f = count_failures(mesh, m, moving, shrink, rays);
                CAPTURE(shape.cubic);
                CAPTURE(shape.segments);
                CAPTURE(shape.radius);
                CAPTURE(shape.bend);
                CAPTURE(m.x.x);
                CAPTURE(m.origin.x);
                CAPTURE(moving);
                CAPTURE(f.met);
                if (show) CHECK(f.outward == 0);
                if (show) CHECK(f.inward <= (shape.cubic ? 1 : 0));
                if (show) CHECK(f.met > rays / 2);
                sum.inward += f.inward, sum.outward += f.outward, sum.met += f.met;
            }
    return sum;
}

}  // namespace

TEST_CASE("no ray meets the curve that it leaves, at any scale and place") {
    const Failures f = sum_of_failures(1, 4000, true);
    CHECK(f.inward < 1e-5 * f.met);  // Embree misses only few exits
}

TEST_CASE("the test of curves sees an error bound that is too small") {
    const Failures f = sum_of_failures(0, 500, false);
    CHECK(f.inward + f.outward > 100);
}

TEST_CASE("texture coordinates run along the whole curve and around it; colours are those of curve or place") {
    const Points points{{0, 0, 0, 0.1f}, {1, 0, 0, 0.1f}, {2, 0, 0, 0.1f},
                        {0, 5, 0, 0.1f}, {1, 5, 0, 0.1f}, {2, 5, 0, 0.1f}};
    for (const bool per_curve : {true, false}) {
        Mesh mesh = curves_mesh(false, points, {2, 4});
        std::vector<std::array<float, 4>> colors;
        std::vector<Vec2f> uv;
        for (int i = 0; i < (per_curve ? 2 : 6); ++i) {
            colors.push_back({float(i), 1, 0.5f, 1});
            uv.push_back({float(10 * i), 7});
        }
        mesh.colors = colors, mesh.uv[0] = uv;
        SceneDescription d = describe(mesh, GltfMaterial{});
        use_textures(d);
        const auto scene = Scene::build(d);
        for (int i = 0; i < 200; ++i) {
            const int curve = i % 2;
            const float x = 0.01f + 1.98f * float(hash_uniform(41, i)), turn = float(2 * kPiD * hash_uniform(42, i));
            const Vec3f out{0, std::cos(turn), std::sin(turn)}, on{x, 5.f * float(curve), 0};
            const auto hit = scene->intersect(test_ray(on + out * 2, -out));
            REQUIRE(hit.has_value());
            const SurfaceHit& s = hit->surface;
            CHECK(s.uv[1].x == doctest::Approx(x / 2).epsilon(1e-4));
            CHECK(s.color[0] == doctest::Approx(per_curve ? float(curve) : x + 3.f * float(curve)).epsilon(1e-4));
            CHECK(s.uv[0].x == doctest::Approx(10 * s.color[0]).epsilon(1e-4));
            CHECK(s.uv[0].y == doctest::Approx(7));
            CHECK(length(s.ns - out) < 1e-4f);
            CHECK(std::abs(s.tangent.x) == doctest::Approx(1).epsilon(1e-4));
            // A rotation by a quarter turn changes v by a quarter.
            const Vec3f next{0, -out.z, out.y};
            const auto other = scene->intersect(test_ray(on + next * 2, -next));
            REQUIRE(other.has_value());
            float way = other->surface.uv[1].y - s.uv[1].y;
            way -= std::floor(way);
            CHECK(std::min(std::abs(way - 0.25f), std::abs(way - 0.75f)) < 1e-3f);
            CHECK(scene->curvature(s) == doctest::Approx(5).epsilon(1e-4));
        }
    }
}

TEST_CASE("the footprint of a cone is what it covers of the way along and around") {
    const float radius = 0.1f, width = 1e-3f;
    const Mesh mesh = curves_mesh(true, bow(2, true, radius, 0, 0), {2});
    SceneDescription d = describe(mesh, GltfMaterial{});
    use_textures(d);
    const auto scene = Scene::build(d);
    for (const float tilt : {0.f, 0.5f}) {
        Ray ray = test_ray({0.6f - tilt, 0, 1.1f}, {tilt, 0, -1});
        ray.cone = {width, 0};
        const auto hit = scene->intersect(ray);
        REQUIRE(hit.has_value());
        for (int set = 0; set < 2; ++set) {
            const UvFootprint& f = hit->surface.footprint[set];
            const float around = std::max(std::abs(f.across.y), std::abs(f.along.y));
            const float along = std::max(std::abs(f.across.x), std::abs(f.along.x));
            CHECK(around == doctest::Approx(width / (2 * kPi * radius)).epsilon(1e-3));
            CHECK(along == doctest::Approx(width * std::sqrt(1 + tilt * tilt)).epsilon(1e-3));
        }
    }
}

TEST_CASE("mirroring a curve turns its bitangent, and not its normals") {
    for (const float side : {1.f, -1.f}) {
        SceneDescription d = describe(curves_mesh(true, bow(1, true, 0.1f, 0, 0), {1}), GltfMaterial{});
        d.instances[0].world_from_local.z = {0, 0, side};
        use_textures(d);
        const auto scene = Scene::build(d);
        const auto hit = scene->intersect(test_ray({0.5f, 0, 2}, {0, 0, -1}));
        REQUIRE(hit.has_value());
        CHECK(hit->surface.ns.z == doctest::Approx(1).epsilon(1e-4));
        CHECK(hit->surface.tangent.x == doctest::Approx(1).epsilon(1e-4));
        CHECK(hit->surface.tangent_sign == side);
    }
}
