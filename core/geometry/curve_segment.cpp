// curve_segment.cpp -- points and normals on the surface of a curve segment, and the inverse map.
//
// The surface of a cubic segment is X(u, a) = c(u) + r(u) R(u, a), where R is the unit vector
// perpendicular to the tangent T at angle a. For a frame without twist, dR/du = -(R . dT/du) T, so
// the normal is R (|c'| - r R . dT/du) - r' T. A straight segment is the cone tangent to both
// balls: its normal is tilted by dr / l against the axis, and X(s) = c(s) + r(s) n.
#include <algorithm>
#include <cmath>

#include "geometry/curve_frames.h"
#include "geometry/curves.h"
#include "geometry/mesh.h"
#include "math/portable.h"

namespace dg {
namespace {

constexpr double kTurn = 2 * kPiD;
constexpr double kNearEnd = 1e-4;  // fraction of a segment

Vec3d second_derivative(const CurveSegment& s, double u) {
    if (!s.cubic) return {};
    return ((s.points[2] - s.points[1] * 2.0 + s.points[0]) * (1 - u) +
            (s.points[3] - s.points[2] * 2.0 + s.points[1]) * u) *
           6.0;
}

double radius_slope(const CurveSegment& s, double u) {
    if (!s.cubic) return s.radii[1] - s.radii[0];
    const double v = 1 - u;
    return 3 * ((s.radii[1] - s.radii[0]) * v * v + (s.radii[2] - s.radii[1]) * 2 * u * v +
                (s.radii[3] - s.radii[2]) * u * u);
}

double size_of(const CurveSegment& s) {
    double most = 0;
    for (int i = 1; i < (s.cubic ? 4 : 2); ++i)
        most = std::max(most, length(s.points[i] - s.points[0]));
    return most;
}

/// Cosine between the normals of a straight segment and its axis. If it would exceed 1, one ball
/// contains the other.
double lean(const CurveSegment& s) {
    const double l = length(s.points[1] - s.points[0]);
    const double dr = s.radii[1] - s.radii[0];
    return l > 0 ? std::clamp(-dr / l, -1.0, 1.0) : 0;
}

/// Unit vectors perpendicular to the curve at an angle, and in the direction of increasing angle.
struct Around {
    Vec3d outward, onward;
};
Around around(const CurveSegment& s, double u, Vec3d along, double angle) {
    const Vec3d x = s.zero_angle(u), y = cross(along, x);
    const double c = std::cos(angle), t = std::sin(angle);
    return {x * c + y * t, y * c - x * t};
}

CurvePoint on_side(const CurveSegment& s, double u, double angle) {
    const Vec3d along = s.tangent(u), first = s.derivative(u);
    const Around a = around(s, u, along, angle);
    const double r = s.radius(u), dr = radius_slope(s, u), speed = length(first);
    const Vec3d second = second_derivative(s, u);
    const double bend = speed > 0 ? dot(second, a.outward) / speed : 0;  // R . dT/du
    // On the inside of a bend tighter than the radius the surface intersects itself.
    const double stretch = std::max(speed - r * bend, 1e-3 * speed);
    Vec3d normal = a.outward * stretch - along * dr;
    const double size = length(normal);
    normal = size > 0 ? normal / size : a.outward;
    return {s.center(u) + a.outward * r, normal, along * stretch + a.outward * dr,
            a.onward * (kTurn * r), r};
}

CurvePoint on_cone(const CurveSegment& s, double u, double angle) {
    const Vec3d along = s.tangent(u);
    const Around a = around(s, u, along, angle);
    const double r = s.radius(u), mu = lean(s), across = std::sqrt(1 - mu * mu);
    const Vec3d normal = along * mu + a.outward * across;
    return {s.center(u) + normal * r, normal, s.derivative(u) + normal * radius_slope(s, u),
            a.onward * (kTurn * r * across), r};
}

CurvePoint on_disc(const CurveSegment& s, bool at_end, double out, double angle) {
    const double u = at_end ? 1 : 0, side = at_end ? 1 : -1;
    const Vec3d along = s.tangent(u);
    const Around a = around(s, u, along, angle);
    const double r = s.radius(u);
    return {s.center(u) + a.outward * (r * out), along * side, a.outward * (-side * r),
            a.onward * (kTurn * r * out), r};
}

/// Angle between the pole of the ball at an end and its contact circle with the cone.
double cap_angle(const CurveSegment& s, bool at_end) {
    return acos(at_end ? lean(s) : -lean(s));
}

CurvePoint on_ball(const CurveSegment& s, bool at_end, double out, double angle) {
    const double u = at_end ? 1 : 0, side = at_end ? 1 : -1;
    const Vec3d along = s.tangent(u);
    const Around a = around(s, u, along, angle);
    const double r = s.radius(u), most = cap_angle(s, at_end), polar = out * most;
    const Vec3d normal = along * (side * std::cos(polar)) + a.outward * std::sin(polar);
    const Vec3d by_polar = a.outward * std::cos(polar) - along * (side * std::sin(polar));
    return {s.center(u) + normal * r, normal, by_polar * (-side * most * r),
            a.onward * (kTurn * r * std::sin(polar)), r};
}

double turn_of(const CurveSegment& s, double u, Vec3d direction) {
    const Vec3d along = s.tangent(u), x = s.zero_angle(u);
    const double angle = atan2(dot(direction, cross(along, x)), dot(direction, x)) / kTurn;
    return angle < 0 ? angle + 1 : angle;
}

/// Below 1, even after rounding.
float share(double turn) { return std::min(float(turn), 1 - 0x1p-24f); }

}  // namespace

CurveWeights weights_at(bool cubic, double u) {
    const double v = 1 - u;
    if (!cubic) return {{v, u, 0, 0}};
    return {{v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u}};
}

Vec3d CurveSegment::center(double u) const {
    const CurveWeights w = weights_at(cubic, u);
    Vec3d sum{};
    for (int i = 0; i < (cubic ? 4 : 2); ++i) sum = sum + points[i] * w.of[i];
    return sum;
}

double CurveSegment::radius(double u) const {
    const CurveWeights w = weights_at(cubic, u);
    double sum = 0;
    for (int i = 0; i < (cubic ? 4 : 2); ++i) sum += radii[i] * w.of[i];
    return sum;
}

Vec3d CurveSegment::derivative(double u) const {
    if (!cubic) return points[1] - points[0];
    const double v = 1 - u;
    return ((points[1] - points[0]) * (v * v) + (points[2] - points[1]) * (2 * u * v) +
            (points[3] - points[2]) * (u * u)) *
           3.0;
}

/// The derivative vanishes where control points coincide; use the direction next to it.
Vec3d CurveSegment::tangent(double u) const {
    const double least = 1e-9 * size_of(*this);
    const double beside = u < 0.5 ? u + kNearEnd : u - kNearEnd;
    for (const Vec3d d : {derivative(u), derivative(beside) / kNearEnd,
                          points[cubic ? 3 : 1] - points[0]})
        if (length(d) > least) return d / length(d);
    return {1, 0, 0};
}

Vec3d CurveSegment::zero_angle(double u) const {
    const Vec3d begin = tangent(0);
    const Vec3d across = transported(reference, begin, begin);
    return u == 0 ? across : transported(across, begin, tangent(u));
}

CurveSegment segment_at(const Mesh& mesh, std::uint32_t segment, float time) {
    const Curves& c = mesh.curves;
    const MeshStep step = step_at(mesh.steps, time);
    const std::size_t start = c.starts[segment], n = mesh.vertex_count();
    const auto between = [&](const Vec3f* values, std::size_t per_step) {
        const Vec3d a = to_double(values[step.index * per_step]);
        if (step.share == 0) return a;
        const Vec3d b = to_double(values[(step.index + 1) * per_step]);
        return a * (1 - double(step.share)) + b * double(step.share);
    };
    CurveSegment s;
    s.cubic = c.cubic;
    for (std::size_t i = 0; i <= c.points_per_segment(); ++i) {
        s.points[i] = between(mesh.positions.data() + start + i, n);
        s.radii[i] = c.radii[start + i];
    }
    if (!c.references.empty())
        s.reference = between(c.references.data() + segment, c.starts.size());
    return s;
}

CurvePoint point_on(const CurveSegment& s, CurvePlace place) {
    const double u = place.along, angle = kTurn * double(place.around);
    if (u >= 0 && u <= 1) return s.cubic ? on_side(s, u, angle) : on_cone(s, u, angle);
    const bool at_end = u > 1;
    const double out = at_end ? 2 - u : 1 + u;  // 1 at the rim
    return s.cubic ? on_disc(s, at_end, out, angle) : on_ball(s, at_end, out, angle);
}

CurvePlace place_of(const CurveSegment& s, double u, Vec3d normal) {
    const float turn = share(turn_of(s, u, normal));
    if (s.cubic || (u != 0 && u != 1)) return {float(u), turn};
    const bool at_end = u == 1;
    const Vec3d along = s.tangent(u) * (at_end ? 1.0 : -1.0);
    const double upright = dot(normal, along);
    const double polar = atan2(length(normal - along * upright), upright);
    const double most = cap_angle(s, at_end);
    const double out = most > 0 ? std::min(polar / most, 1.0) : 1;
    return {float(at_end ? 2 - out : out - 1), turn};
}

CurvePlace place_on_cap(const CurveSegment& s, bool at_end, Vec3d offset) {
    const double u = at_end ? 1 : 0, r = s.radius(u);
    const double out = r > 0 ? std::min(length(offset) / r, 1.0) : 1;
    return {float(at_end ? 2 - out : out - 1), share(turn_of(s, u, offset))};
}

}  // namespace dg
