// curves_test.cpp -- round curves against closed forms: cylinders, cones, balls and tori; surface
// points and normals; error messages.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "geometry/intersector.h"
#include "geometry/mesh.h"
#include "geometry/round_cone.h"
#include "math/error.h"
#include "math/hash.h"

using namespace dg;

namespace {

double random_number(int stream, int i) { return hash_uniform(stream, i); }

Vec3d random_direction(int i) {
    const double z = 2 * random_number(51, i) - 1, phi = 2 * kPiD * random_number(52, i);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Single curve of control points (x, y, z, radius), at one or more time steps.
Mesh curve_mesh(bool cubic, std::vector<std::vector<std::array<float, 4>>> steps) {
    Mesh mesh;
    mesh.name = "hair";
    mesh.steps = std::uint32_t(steps.size());
    mesh.curves.cubic = cubic;
    std::vector<Vec3f> points;
    std::vector<float> radii;
    for (const auto& step : steps)
        for (const auto& p : step) points.push_back({p[0], p[1], p[2]});
    for (const auto& p : steps[0]) radii.push_back(p[3]);
    std::vector<std::uint32_t> starts;
    const std::uint32_t step = cubic ? 3 : 1;
    for (std::uint32_t i = 0; i + step < radii.size(); i += step) starts.push_back(i);
    mesh.positions = std::move(points);
    mesh.curves.radii = std::move(radii);
    mesh.curves.ends = {std::uint32_t(starts.size())};
    mesh.curves.starts = std::move(starts);
    mesh.curves.complete(mesh);
    return mesh;
}

/// Straight line from a to b in `segments` of constant speed; the radius goes from r to s.
Mesh straight(bool cubic, Vec3d a, Vec3d b, double r, double s, int segments = 2) {
    const int n = segments * (cubic ? 3 : 1);
    std::vector<std::array<float, 4>> points;
    for (int i = 0; i <= n; ++i) {
        const double t = double(i) / n;
        const Vec3f p = to_float(a * (1 - t) + b * t);
        points.push_back({p.x, p.y, p.z, float(r * (1 - t) + s * t)});
    }
    return curve_mesh(cubic, {points});
}

Ray ray_to(Vec3d from, Vec3d target) {
    Ray ray;
    ray.origin = to_float(from);
    ray.direction = normalize(to_float(target) - ray.origin);
    return ray;
}

struct Met {
    double t;
    Vec3d normal, position;
    CurvePlace place;
    std::uint32_t segment;
};

/// Traces curves directly or through an instance.
class Tracer {
  public:
    explicit Tracer(Mesh mesh, const Affine3f& placed = {}, const Motion* motion = nullptr)
        : meshes_{std::move(mesh)}, placed_(to_double(placed)) {
        InstanceGeometry instance{0, placed};
        instance.motion = motion;
        tracer_ = Intersector::build(meshes_, {instance}, {}, {});
    }
    std::optional<Met> meet(const Ray& ray) const {
        const auto hit = tracer_->intersect(ray);
        CHECK(hit.has_value() == tracer_->occluded(ray));
        if (!hit) return std::nullopt;
        CHECK(hit->instance == 0);
        const CurveSegment s = segment_at(meshes_[0], hit->primitive, ray.time);
        const CurvePoint p = point_on(s, {hit->u, hit->v});
        return Met{hit->t, normalize(placed_.normal(p.normal)), placed_.point(p.position),
                   {hit->u, hit->v}, hit->primitive};
    }
    const Intersector& tracer() const { return *tracer_; }

  private:
    std::vector<Mesh> meshes_;
    Affine3d placed_;
    std::unique_ptr<Intersector> tracer_;
};

/// Nearest hit t > 0 of a ray on the side of a cone around the segment ab, with radius r to s
/// perpendicular to the axis; empty for a miss or a hit on the ends first.
std::optional<double> side_of_cone(const Ray& ray, Vec3d a, Vec3d b, double r, double s) {
    const Vec3d axis = normalize(b - a), o = to_double(ray.origin) - a, d = to_double(ray.direction);
    const double l = length(b - a), k = (s - r) / l;
    const double oz = dot(o, axis), dz = dot(d, axis);
    const Vec3d ox = o - axis * oz, dx = d - axis * dz;
    // |ox + t dx|^2 = (r + k (oz + t dz))^2
    const double base = r + k * oz, grow = k * dz;
    const double qa = dot(dx, dx) - grow * grow, qb = dot(ox, dx) - base * grow,
                 qc = dot(ox, ox) - base * base;
    const double disc = qb * qb - qa * qc;
    if (disc < 0) return std::nullopt;
    const double t = (-qb - std::sqrt(disc)) / qa, z = oz + t * dz;
    if (z < 0 || z > l || t < 0) return std::nullopt;
    return t;
}

Vec3d cone_normal(Vec3d p, Vec3d a, Vec3d b, double r, double s) {
    const Vec3d axis = normalize(b - a), out = p - a - axis * dot(p - a, axis);
    return normalize(normalize(out) - axis * ((s - r) / length(b - a)));
}

std::string message(const Mesh& mesh) {
    try {
        mesh.validate();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a straight cubic curve is a cylinder or a cone, at any scale") {
    for (const double scale : {1e-4, 1.0, 1e3})
        for (const double end : {1.0, 0.3, 0.0}) {
            const Vec3d a = Vec3d{0.1, -0.4, 0.2} * scale, b = Vec3d{1.5, 0.7, -0.6} * scale;
            const double r = 0.05 * scale, s = r * end;
            const Tracer tracer(straight(true, a, b, r, s));
            int met = 0;
            for (int i = 0; i < 4000; ++i) {
                const double along = 0.05 + 0.9 * random_number(1, i);
                const Vec3d axis = normalize(b - a), side = normalize(cross(axis, random_direction(i)));
                const double off = (1.9 * random_number(2, i) - 0.95) * (r * (1 - along) + s * along);
                const Vec3d target = a * (1 - along) + b * along + side * off;
                const Vec3d from = target + normalize(cross(side, axis) + axis * (random_number(3, i) - 0.5)) *
                                                (2 * scale);
                const Ray ray = ray_to(from, target);
                const auto wanted = side_of_cone(ray, a, b, r, s);
                if (!wanted) continue;
                const auto hit = tracer.meet(ray);
                REQUIRE(hit.has_value());
                ++met;
                CHECK(hit->t == doctest::Approx(*wanted).epsilon(1e-4));
                const Vec3d p = to_double(ray.origin) + to_double(ray.direction) * *wanted;
                CHECK(length(hit->position - p) < 2e-3 * r + 1e-6 * scale);
                const double grazing = std::abs(dot(hit->normal, to_double(ray.direction)));
                const double here = r + (s - r) * dot(p - a, axis) / length(b - a);
                if (grazing > 0.3)  // Embree's position has an error of about 1e-4 of r
                    CHECK(length(hit->normal - cone_normal(p, a, b, r, s)) < 5e-4 * r / here);
                CHECK(hit->place.along >= 0);
                CHECK(hit->place.along <= 1);
            }
            CHECK(met > 3000);
        }
}

TEST_CASE("normals are those of the surface: across both ways to go on it") {
    const std::vector<std::array<float, 4>> bent{{0, 0, 0, 0.2f}, {1, 0, 0, 0.1f}, {1, 1, 0, 0.3f}, {1, 2, 1, 0.1f}};
    for (const bool cubic : {true, false}) {
        const Mesh mesh = curve_mesh(cubic, {bent});
        for (int i = 0; i < 2000; ++i) {
            const std::uint32_t segment = i % mesh.curves.starts.size();
            const CurveSegment s = segment_at(mesh, segment, 0);
            const float u = float(3 * random_number(4, i) - 1), v = float(random_number(5, i));
            const float h = 1e-3f;
            if (std::abs(u) < 2 * h || std::abs(u - 1) < 2 * h) continue;  // rims
            const CurvePoint p = point_on(s, {u, v});
            const Vec3d by_u = (point_on(s, {u + h, v}).position - point_on(s, {u - h, v}).position) /
                               (2.0 * double(h));
            const Vec3d by_v = (point_on(s, {u, v + h}).position - point_on(s, {u, v - h}).position) /
                               (2.0 * double(h));
            CHECK(length(p.normal) == doctest::Approx(1));
            CHECK(std::abs(dot(p.normal, by_u)) < 2e-3 * length(by_u));
            CHECK(std::abs(dot(p.normal, by_v)) < 2e-3 * length(by_v));
            CHECK(dot(cross(by_v, by_u), p.normal) > 0);
            CHECK(length(p.by_around - by_v) < 1e-3 * length(by_v) + 1e-6);
            // Twist of the frame adds a component around the curve to the derivative along it.
            const Vec3d w = normalize(p.by_around), off = p.by_along - by_u;
            CHECK(length(off - w * dot(off, w)) < 2e-3 * length(by_u) + 1e-5);
        }
    }
}

TEST_CASE("places of normals are found again") {
    const std::vector<std::array<float, 4>> bent{{0, 0, 0, 0.2f}, {1, 0, 0, 0.1f}, {1, 1, 0, 0.3f}, {1, 2, 1, 0.1f}};
    for (const bool cubic : {true, false}) {
        const Mesh mesh = curve_mesh(cubic, {bent});
        for (int i = 0; i < 1000; ++i) {
            const CurveSegment s = segment_at(mesh, i % mesh.curves.starts.size(), 0);
            const double u = cubic ? random_number(6, i) : 3 * random_number(6, i) - 1;
            const CurvePlace place{float(u), float(random_number(7, i))};
            const CurvePoint p = point_on(s, place);
            const CurvePlace again = place_of(s, std::clamp(u, 0.0, 1.0), p.normal);
            CHECK(length(point_on(s, again).position - p.position) < 1e-5);
        }
    }
}

TEST_CASE("flat ends of cubic curves, round ends of straight ones") {
    const Vec3d a{0, 0, 0}, b{1, 0, 0};
    const double r = 0.25, s = 0.1;
    const Tracer flat(straight(true, a, b, r, s));
    const Tracer round(straight(false, a, b, r, s));
    for (int i = 0; i < 4000; ++i) {
        const double angle = 2 * kPiD * random_number(8, i);
        const bool at_end = i % 2;
        const double out = std::sqrt(random_number(9, i)) * 0.99 * (at_end ? s : r);
        const Vec3d on{at_end ? 1.0 : 0.0, out * std::cos(angle), out * std::sin(angle)};
        const Vec3d from{at_end ? 3.0 : -2.0, random_number(10, i) - 0.5, random_number(11, i) - 0.5};
        Ray ray = ray_to(from, on);
        auto hit = flat.meet(ray);
        REQUIRE(hit.has_value());
        CHECK(hit->t == doctest::Approx(length(on - from)).epsilon(1e-5));
        CHECK(length(hit->position - on) < 1e-5);
        CHECK(hit->normal.x == (at_end ? 1 : -1));
        CHECK((at_end ? hit->place.along > 1 : hit->place.along < 0));
        CHECK(hit->segment == (at_end ? 1 : 0));
        // The cap is part of the ball at the end.
        hit = round.meet(ray);
        const Vec3d o = to_double(ray.origin) - (at_end ? b : a), d = to_double(ray.direction);
        const double radius = at_end ? s : r, half = dot(o, d);
        const double disc = half * half - dot(o, o) + radius * radius;
        REQUIRE(disc > 0);
        const double t = -half - std::sqrt(disc);
        const Vec3d met = o + d * t;
        const double lean = (r - s) * radius;  // dot product of a point of the rim with the axis
        if (at_end ? met.x < lean + 1e-4 : met.x > lean - 1e-4) continue;
        REQUIRE(hit.has_value());
        CHECK(hit->t == doctest::Approx(t).epsilon(1e-4));
        CHECK(length(hit->normal - met / radius) < 2e-3);
        CHECK(length(hit->position - (met + (at_end ? b : a))) < 1e-3 * radius);
    }
}

TEST_CASE("a straight curve is closed: a ray from inside leaves it once") {
    for (const bool cubic : {true, false}) {
        const Tracer tracer(straight(cubic, {0, 0, 0}, {1, 0.5, 0.25}, 0.1, 0.2, 3));
        int left = 0;
        for (int i = 0; i < 4000; ++i) {
            const double t = 0.1 + 0.8 * random_number(12, i);
            const Vec3d from = Vec3d{1, 0.5, 0.25} * t + random_direction(2 * i) * 0.05;
            Ray ray = ray_to(from, from + random_direction(2 * i + 1));
            const auto hit = tracer.meet(ray);
            if (!hit) continue;
            left += dot(hit->normal, to_double(ray.direction)) > 0;
            ray.t_min = float(hit->t) + 1e-3f;
            CHECK_FALSE(tracer.meet(ray).has_value());
        }
        CHECK(left >= 3999);
    }
}

TEST_CASE("the hull of two balls: a ray goes in where it comes from outside, at any length over radius") {
    for (const double r : {0.3, 1e-3, 1e-5})
        for (const double ratio : {1.0, 0.2, 0.0}) {
            const Vec3d a{0.3, 0.2, 0.1}, b{-0.5, 0.4, 0.3};
            const RoundCone cone{a, b, r, ratio * r};
            for (int i = 0; i < 2000; ++i) {
                const double u = 1.6 * random_number(16, i) - 0.3;
                const Vec3d target = a + (b - a) * u + random_direction(2 * i) * (1.2 * r);
                const Vec3d from = target + random_direction(2 * i + 1) * 5.0;
                const RoundConeCrossings met = cross_round_cone(cone, from, target - from);
                for (int k = 0; k < met.count; ++k) {
                    const RoundConeCrossing& x = met.of[k];
                    const double here = r + (ratio * r - r) * x.along;
                    const Vec3d centre = a + (b - a) * x.along;
                    CHECK(length(x.point - centre) == doctest::Approx(here).epsilon(1e-6));
                    CHECK(length(x.point - centre - x.normal * here) < 1e-5 * r);
                    CHECK((dot(x.normal, target - from) > 0) == (k == 1));
                    // The body is convex: it does not extend beyond the tangent plane.
                    CHECK(dot(a - x.point, x.normal) + r < 1e-5 * r);
                    CHECK(dot(b - x.point, x.normal) + ratio * r < 1e-5 * r);
                    CHECK(cone.holds(x.point - x.normal * (0.01 * here), 0));
                    CHECK_FALSE(cone.holds(x.point + x.normal * (0.01 * r), 0));
                }
                if (met.count == 2) {
                    const Vec3d middle = (met.of[0].point + met.of[1].point) * 0.5;
                    if (length(met.of[1].point - met.of[0].point) > 0.1 * r) CHECK(cone.holds(middle, 0));
                } else {
                    CHECK_FALSE(cone.holds(target, 0));
                }
            }
        }
}

TEST_CASE("a polyline is one body: in at its outside, out at its outside, nothing between") {
    const Tracer tracer(curve_mesh(false, {{{0, 0, 0, 0.2f}, {1, 0.6f, 0, 0.25f}, {2, -0.2f, 0.5f, 0.15f},
                                            {2.2f, 1, 0.6f, 0.2f}}}));
    const auto depth = [&](Vec3d p) {  // distance outside of the union
        double least = 1e9;
        const std::vector<std::array<double, 4>> at{{0, 0, 0, 0.2}, {1, 0.6, 0, 0.25}, {2, -0.2, 0.5, 0.15}, {2.2, 1, 0.6, 0.2}};
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j <= 400; ++j) {
                const double t = j / 400.0;
                const Vec3d c{at[k][0] * (1 - t) + at[k + 1][0] * t, at[k][1] * (1 - t) + at[k + 1][1] * t,
                              at[k][2] * (1 - t) + at[k + 1][2] * t};
                least = std::min(least, length(p - c) - (at[k][3] * (1 - t) + at[k + 1][3] * t));
            }
        return least;
    };
    for (int i = 0; i < 3000; ++i) {
        Ray ray = ray_to(random_direction(2 * i) * 5.0, Vec3d{1, 0.2, 0.2} + random_direction(2 * i + 1) * 0.8);
        bool inside = false;
        for (int k = 0; k < 12; ++k) {
            const auto hit = tracer.meet(ray);
            if (!hit) break;
            CHECK(std::abs(depth(hit->position)) < 1e-4);
            const double cosine = dot(hit->normal, to_double(ray.direction));
            if (std::abs(cosine) > 0.02) CHECK((cosine > 0) == inside);
            inside = cosine > 0 ? false : true;
            ray.t_min = float(hit->t) + 2e-5f;
        }
        CHECK_FALSE(inside);
    }
}

TEST_CASE("a ring of many cubic segments is a torus") {
    // Cubic arcs of 1/16 turn are circular to 2e-8: h = 4/3 tan(angle / 4).
    constexpr int kArcs = 16;
    const double big = 1, small = 0.2, arc = 2 * kPiD / kArcs, h = 4.0 / 3 * std::tan(arc / 4);
    std::vector<std::array<float, 4>> points;
    for (int k = 0; k < kArcs; ++k) {
        const double a = k * arc, b = a + arc;
        const auto add = [&](double x, double y) { points.push_back({float(x), float(y), 0, float(small)}); };
        add(std::cos(a), std::sin(a));
        add(std::cos(a) - h * std::sin(a), std::sin(a) + h * std::cos(a));
        add(std::cos(b) + h * std::sin(b), std::sin(b) - h * std::cos(b));
    }
    points.push_back(points[0]);
    Mesh mesh = curve_mesh(true, {points});
    mesh.curves.closed = true;
    const Tracer tracer(mesh);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3d from = random_direction(3 * i) * 3.0, target = random_direction(3 * i + 1);
        const auto hit = tracer.meet(ray_to(from, target));
        if (!hit) continue;
        ++met;
        const Vec3d p = hit->position;
        const Vec3d centre = normalize(Vec3d{p.x, p.y, 0}) * big;
        CHECK(length(p - centre) == doctest::Approx(small).epsilon(1e-4));
        CHECK(length(hit->normal - (p - centre) / small) < 1e-4);
        const Vec3d there = from + normalize(target - from) * hit->t;
        CHECK(length(there - p) < 1e-4);
        CHECK(dot(hit->normal, target - from) < 0);  // seen from outside
    }
    CHECK(met > 1000);
}

TEST_CASE("placed curves: scaled, sheared and mirrored, and many times") {
    const Vec3d a{0, 0, 0}, b{1, 0, 0};
    const Affine3f placements[] = {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 2, 3}},
                                   {{-1e-3f, 0, 0}, {0, 1e-3f, 0}, {0, 0, 1e-3f}, {0, 0, 0}},
                                   {{1, 0.4f, 0}, {0.7f, 2, 0.1f}, {0, -0.3f, 0.5f}, {-1, 0, 2}}};
    for (const Affine3f& m : placements) {
        const Affine3d there = to_double(m), back = inverse(there);
        const Motion still_motion(there);
        const Tracer placed(straight(true, a, b, 0.1, 0.1), m);
        for (int i = 0; i < 1000; ++i) {
            const double t = 0.1 + 0.8 * random_number(13, i);
            const Vec3d from = there.point({t, 2 * std::cos(i), 2 * std::sin(i)}), target = there.point({t, 0, 0});
            const Ray ray = ray_to(from, target);
            Ray local;
            local.origin = to_float(back.point(to_double(ray.origin)));
            local.direction = to_float(back.vector(to_double(ray.direction)));
            const auto wanted = side_of_cone(local, a, b, 0.1, 0.1);
            const auto hit = placed.meet(ray);
            REQUIRE(wanted.has_value());
            REQUIRE(hit.has_value());
            CHECK(hit->t == doctest::Approx(*wanted).epsilon(1e-4));
            const Vec3d p = to_double(local.origin) + to_double(local.direction) * *wanted;
            CHECK(length(hit->normal - normalize(there.normal(cone_normal(p, a, b, 0.1, 0.1)))) < 2e-3);
        }
    }
}

TEST_CASE("moving points: a curve is met where it is at the time of the ray") {
    std::vector<std::vector<std::array<float, 4>>> steps;
    for (int step = 0; step < 3; ++step) {
        const float y = float(step * step);
        steps.push_back({{0, y, 0, 0.1f}, {1, y, 0, 0.1f}, {2, y, 0, 0.1f}, {3, y, 0, 0.1f}});
    }
    const Tracer cubic(curve_mesh(true, steps)), linear(curve_mesh(false, steps));
    for (int i = 0; i < 2000; ++i) {
        const Tracer& tracer = i % 2 ? cubic : linear;
        Ray ray;
        ray.time = float(random_number(14, i));
        const double y = ray.time < 0.5f ? 2 * double(ray.time) : 1 + 3 * (2 * double(ray.time) - 1);
        ray.origin = {float(0.2 + 2.6 * random_number(15, i)), float(y), 3};
        ray.direction = {0, 0, -1};
        const auto hit = tracer.meet(ray);
        REQUIRE(hit.has_value());
        CHECK(hit->t == doctest::Approx(2.9).epsilon(1e-5));
        CHECK(hit->position.y == doctest::Approx(y).epsilon(1e-5));
        ray.origin.y += 0.11f;
        CHECK_FALSE(tracer.meet(ray).has_value());
        ray.origin = {-1, float(y), 0};  // the cap moves along
        ray.direction = {1, 0, 0};
        CHECK(tracer.meet(ray)->t == doctest::Approx(i % 2 ? 1 : 0.9).epsilon(1e-5));
    }
}

TEST_CASE("directions across a curve turn as little as they can, and go on over its joints") {
    const Mesh mesh = curve_mesh(true, {{{0, 0, 0, 1}, {1, 0, 0, 1}, {2, 1, 0, 1}, {3, 1, 1, 1},
                                         {4, 1, 2, 1}, {4, 2, 3, 1}, {4, 3, 3, 1}}});
    const CurveSegment a = segment_at(mesh, 0, 0), b = segment_at(mesh, 1, 0);
    CHECK(length(a.zero_angle(1) - b.zero_angle(0)) < 1e-6);
    Vec3d before = a.zero_angle(0);
    for (int i = 0; i <= 100; ++i) {
        const double u = i / 100.0;
        const Vec3d now = a.zero_angle(u);
        CHECK(std::abs(dot(now, a.tangent(u))) < 1e-9);
        CHECK(length(now) == doctest::Approx(1));
        CHECK(length(now - before) < 0.1);
        before = now;
    }
}

TEST_CASE("control points that coincide give numbers all the same") {
    for (const bool cubic : {true, false})
        for (const auto& points : std::vector<std::vector<std::array<float, 4>>>{
                 {{0, 0, 0, 0.1f}, {0, 0, 0, 0.1f}, {0, 0, 0, 0.1f}, {0, 0, 0, 0.1f}},
                 {{0, 0, 0, 0.1f}, {0, 0, 0, 0.1f}, {1, 0, 0, 0.1f}, {1, 0, 0, 0.1f}},
                 {{0, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}},
                 {{0, 0, 0, 1}, {1, 0, 0, 0.1f}, {0, 0, 0, 1}, {1, 0, 0, 0.1f}},
                 {{0, 0, 0, 9}, {1, 0, 0, 0.1f}, {2, 0, 0, 9}, {3, 0, 0, 0.1f}}}) {
            const Tracer tracer(curve_mesh(cubic, {points}));
            for (int i = 0; i < 500; ++i) {
                const auto hit = tracer.meet(ray_to(random_direction(2 * i) * 20.0, random_direction(2 * i + 1)));
                if (!hit) continue;
                CHECK(std::isfinite(hit->t));
                CHECK(std::isfinite(length(hit->position)));
                CHECK(length(hit->normal) == doctest::Approx(1));
                CHECK(std::abs(hit->place.along - 0.5f) <= 1.5f);
                CHECK(hit->place.around >= 0);
                CHECK(hit->place.around < 1);
            }
        }
}

TEST_CASE("bad curves are an error that names curve and element") {
    const auto good = [] { return straight(true, {0, 0, 0}, {1, 0, 0}, 0.1, 0.1); };
    Mesh mesh = good();
    CHECK(message(mesh) == "");
    mesh.curves.radii = {0.1f};
    CHECK(message(mesh) == "curves 'hair': length of radii: wanted 7 (one per position), got 1");
    mesh = good();
    mesh.curves.radii = std::vector<float>(7, -1.f);
    CHECK(message(mesh).find("curves 'hair': radius of position 0: wanted a number from 0") == 0);
    mesh = good();
    mesh.curves.starts = {0, 4};
    CHECK(message(mesh) == "curves 'hair': start of segment 1: wanted 3, got 4");
    mesh = good();
    mesh.curves.ends = {3};
    CHECK(message(mesh).find("end of curve 0") != std::string::npos);
    mesh = good();
    mesh.curves.ends = {1};
    CHECK(message(mesh).find("positions") != std::string::npos);
    mesh = good();
    mesh.triangles = {{0, 1, 2}};
    CHECK(message(mesh).find("curves cannot have triangles") != std::string::npos);
    mesh = good();
    mesh.colors = std::vector<std::array<float, 4>>(3);
    CHECK(message(mesh).find("length of colours") != std::string::npos);
    mesh.colors = std::vector<std::array<float, 4>>(1);  // one per curve
    CHECK(message(mesh) == "");
}
