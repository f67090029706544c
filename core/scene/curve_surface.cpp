#include "scene/curve_surface.h"

#include <algorithm>

namespace dg {
namespace {

// Error of Embree's hits on a curve, relative to the radius and to the length of a segment (it grows with the largest
// coordinate relative to the ray). Measured by the test of rays that leave curves, which fails below 0.3 of these
// values.
constexpr double kOfRadius = 2e-4, kOfLength = 8e-6;
// Straight segments are intersected in double.
constexpr double kOfStraightRadius = 1e-6;

/// Scale of the transform along its axes.
double growth(const Affine3d& m) { return std::max({length(m.x), length(m.y), length(m.z)}); }

double length_of(const CurveSegment& s) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += length(s.points[i + 1] - s.points[i]);
    return sum;
}

float error_at(const Placement& place, const CurveSegment& s, const CurvePoint& p) {
    const double rounding =
        double(place.error_scale) * largest_coordinate(p.position) + double(place.error_base);
    const double search = s.cubic ? kOfRadius * p.radius + kOfLength * length_of(s)
                                  : kOfStraightRadius * p.radius;
    return float(rounding + search * growth(place.world_from_local));
}

double on_segment(CurvePlace place) { return std::clamp(double(place.along), 0.0, 1.0); }

Vec2f own_uv(const Curves& c, std::uint32_t segment, CurvePlace place) {
    const std::uint32_t curve = c.curve_of(segment), first = c.first_segment(curve);
    const double along = (segment - first + on_segment(place)) / double(c.ends[curve] - first);
    return {float(along), place.around};
}

Vec2f plus(Vec2f a, Vec2f b, float weight) { return a + b * weight; }
std::array<float, 4> plus(std::array<float, 4> a, const std::array<float, 4>& b, float weight) {
    for (int i = 0; i < 4; ++i) a[i] += b[i] * weight;
    return a;
}

/// Attribute with one value per curve or one per position.
template <typename T>
T value_at(const SharedArray<T>& values, const Curves& c, std::uint32_t segment, double u) {
    if (values.size() == c.ends.size()) return values[c.curve_of(segment)];
    const CurveWeights w = weights_at(c.cubic, u);
    T sum{};
    for (std::uint32_t i = 0; i <= c.points_per_segment(); ++i)
        sum = plus(sum, values[c.starts[segment] + i], float(w.of[i]));
    return sum;
}

void set_frame(const Placement& place, const CurvePoint& p, SurfaceHit& hit) {
    const Vec3f along = to_float(place.world_from_local.vector(p.by_along));
    const Vec3f flat = along - hit.ns * dot(along, hit.ns);
    hit.tangent = length_squared(flat) > 1e-30f ? normalize(flat) : Frame::from_normal(hit.ns).x;
    hit.tangent_sign = place.mirrored ? -1.f : 1.f;
}

}  // namespace

void curve_surface_at(const InstanceRecord& r, const Placement& place, std::uint32_t segment,
                      CurvePlace at, SurfaceHit& hit) {
    const CurveSegment s = segment_at(*r.curves, segment, hit.time);
    const CurvePoint p = point_on(s, at);
    hit.position = to_float(place.world_from_local.point(p.position));
    hit.error = error_at(place, s, p);
    hit.ng = hit.ns = to_float(normalize(place.normal_matrix.vector(p.normal)));
    interpolate_curve(r, segment, at, hit);
    if (r.needs_frame) set_frame(place, p, hit);
}

void interpolate_curve(const InstanceRecord& r, std::uint32_t segment, CurvePlace at,
                       SurfaceHit& hit) {
    const Curves& c = r.curves->curves;
    const double u = on_segment(at);
    if (r.textured) {
        hit.uv[1] = own_uv(c, segment, at);
        hit.uv[0] = r.uv[0] ? value_at(r.curves->uv[0], c, segment, u) : hit.uv[1];
    }
    if (!r.colors) return;
    const std::array<float, 4> color = value_at(r.curves->colors, c, segment, u);
    std::ranges::copy(color, hit.color);
}

Vec3d curve_point_at(const InstanceRecord& r, std::uint32_t segment, CurvePlace at, float time) {
    PlacementRoom made;
    const Placement& place = r.placement(time, made);
    return place.world_from_local.point(
        point_on(segment_at(*r.curves, segment, time), at).position);
}

float curve_curvature(const InstanceRecord& r, const Placement& place, std::uint32_t segment) {
    const Curves& c = r.curves->curves;
    const std::uint32_t first = c.starts[segment];
    const double radius = 0.5 * (double(c.radii[first]) + double(c.radii[first + c.points_per_segment()]));
    const double world = radius * growth(place.world_from_local);
    return world > 0 ? float(0.5 / world) : 0;  // a tube is curved in one direction only
}

/// Recovers the position on the segment from the texture coordinates.
TexturedPatch curve_patch(const InstanceRecord& r, const Placement& place, std::uint32_t segment,
                          const SurfaceHit& hit) {
    const Curves& c = r.curves->curves;
    const std::uint32_t curve = c.curve_of(segment), first = c.first_segment(curve);
    const float count = float(c.ends[curve] - first);
    const float u = std::clamp(hit.uv[1].x * count - float(segment - first), 0.f, 1.f);
    const CurvePoint p = point_on(segment_at(*r.curves, segment, hit.time), {u, hit.uv[1].y});
    const auto world = [&](Vec3d v) { return to_float(place.world_from_local.vector(v)); };
    TexturedPatch patch{{world(p.by_along), world(p.by_around)}, {}};
    patch.uv[1] = {Vec2f{1 / count, 0}, Vec2f{0, 1}};
    patch.uv[0] = patch.uv[1];
    if (r.uv[0]) {
        constexpr double kStep = 1e-3;
        const Vec2f a = value_at(r.curves->uv[0], c, segment, u - kStep),
                    b = value_at(r.curves->uv[0], c, segment, u + kStep);
        patch.uv[0] = {(b - a) * float(0.5 / kStep), Vec2f{0, 0}};
    }
    return patch;
}

}  // namespace dg
