#include "geometry/embree_rounds.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "geometry/embree_inside.h"
#include "geometry/round_cone.h"

namespace dg::embree {
namespace {

// Tolerance relative to the radius: surfaces of consecutive segments that continue each other are
// not inside each other.
constexpr double kInside = 1e-6;

RoundCone cone_at(const Mesh& mesh, std::uint32_t segment, float time) {
    const std::size_t start = mesh.curves.starts[segment], n = mesh.vertex_count();
    const MeshStep step = step_at(mesh.steps, time);
    const auto point = [&](std::size_t i) {
        const Vec3f* now = mesh.positions.data() + step.index * n + i;
        if (step.share == 0) return to_double(*now);
        return to_double(*now) * (1 - double(step.share)) + to_double(now[n]) * double(step.share);
    };
    return {point(start), point(start + 1), mesh.curves.radii[start], mesh.curves.radii[start + 1]};
}

/// Most rays that enter the box of a thin segment miss its axis.
bool comes_near(const RoundCone& cone, Vec3d origin, Vec3d way) {
    const Vec3d across = cross(way, cone.b - cone.a);
    const double off = dot(cone.a - origin, across), radius = std::max(cone.ra, cone.rb);
    return off * off <= 1.0001 * radius * radius * dot(across, across) || dot(across, across) == 0;
}

std::optional<std::uint32_t> neighbour(const Curves& c, std::uint32_t segment, bool after) {
    const bool last = after ? c.ends_curve(segment) : c.begins_curve(segment);
    if (!last) return after ? segment + 1 : segment - 1;
    if (!c.closed) return std::nullopt;
    const std::uint32_t curve = c.curve_of(segment);
    return after ? c.first_segment(curve) : c.ends[curve] - 1;
}

/// Whether a crossing is on the surface of the curve: the segments of a curve form a union, so
/// points inside a neighbour are not. The ball between two segments belongs to the first.
bool is_surface(const Mesh& mesh, std::uint32_t segment, const RoundConeCrossing& x, float time) {
    const Curves& c = mesh.curves;
    const auto before = neighbour(c, segment, false), after = neighbour(c, segment, true);
    if (x.along <= 0 && before) return false;
    for (const auto& other : {before, after}) {
        if (!other || *other == segment) continue;
        const RoundCone cone = cone_at(mesh, *other, time);
        if (cone.holds(x.point, kInside * std::max(cone.ra, cone.rb))) return false;
    }
    return true;
}

void bounds_of_segment(const RTCBoundsFunctionArguments* a) {
    const Mesh& mesh = *static_cast<const RoundSegments*>(a->geometryUserPtr)->mesh;
    const std::uint32_t start = mesh.curves.starts[a->primID];
    Vec3f low, high;
    for (std::uint32_t i = 0; i < 2; ++i) {
        const Vec3f p = mesh.positions[a->timeStep * mesh.vertex_count() + start + i];
        const float r = mesh.curves.radii[start + i];
        for (int k = 0; k < 3; ++k) {
            const float reach = r + 4 * 0x1p-24f * (std::abs(p[k]) + r);
            low[k] = i == 0 ? p[k] - reach : std::min(low[k], p[k] - reach);
            high[k] = i == 0 ? p[k] + reach : std::max(high[k], p[k] + reach);
        }
    }
    set_bounds(*a->bounds_o, low, high);
}

struct Asked {
    const RoundSegments& segments;
    std::uint32_t segment, geometry;
    QueryContext* context;
    RTCFilterFunctionN filter;
};

bool accepts(const Asked& asked, RTCRay& ray, RTCHit& hit) {
    if (!asked.filter) return true;
    int valid = -1;
    RTCFilterFunctionNArguments arguments{};
    arguments.valid = &valid;
    arguments.geometryUserPtr = asked.segments.owner;
    arguments.context = asked.context;
    arguments.ray = reinterpret_cast<RTCRayN*>(&ray);
    arguments.hit = reinterpret_cast<RTCHitN*>(&hit);
    arguments.N = 1;
    asked.filter(&arguments);
    return valid != 0;
}

/// Intersects a segment within the ray's interval; on a hit, updates `ray` and `hit`.
bool meet(const Asked& asked, RTCRay& ray, RTCHit& hit) {
    const Mesh& mesh = *asked.segments.mesh;
    const RoundCone cone = cone_at(mesh, asked.segment, ray.time);
    const Vec3d origin{ray.org_x, ray.org_y, ray.org_z}, way{ray.dir_x, ray.dir_y, ray.dir_z};
    if (!comes_near(cone, origin, way)) return false;
    const RoundConeCrossings met = cross_round_cone(cone, origin, way);
    const float far = ray.tfar;
    for (int i = 0; i < met.count; ++i) {
        const RoundConeCrossing& x = met.of[i];
        if (!(x.t > ray.tnear && x.t < far) || !is_surface(mesh, asked.segment, x, ray.time)) continue;
        const CurvePlace place =
            place_of(segment_at(mesh, asked.segment, ray.time), x.along, x.normal);
        hit.u = place.along, hit.v = place.around;
        hit.primID = asked.segment;
        hit.geomID = asked.geometry;
        hit.instID[0] = asked.context->instID[0];
        ray.tfar = float(x.t);
        if (accepts(asked, ray, hit)) return true;
        ray.tfar = far;
    }
    return false;
}

void intersect_segment(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& segments = *static_cast<const RoundSegments*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    RTCHit hit = world.hit;
    if (meet({segments, a->primID, a->geomID, a->context, segments.on_hit}, world.ray, hit)) world.hit = hit;
}

void occlude_segment(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& segments = *static_cast<const RoundSegments*>(a->geometryUserPtr);
    auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
    RTCHit hit;
    if (meet({segments, a->primID, a->geomID, a->context, segments.on_shadow}, ray, hit))
        ray.tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace

GeometryOwner geometry_of(Device& device, RoundSegments& segments) {
    GeometryOwner geometry = device.new_geometry(RTC_GEOMETRY_TYPE_USER,
                                                 "curves '" + segments.mesh->name + "'");
    rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(segments.mesh->curves.starts.size()));
    rtcSetGeometryTimeStepCount(geometry.get(), segments.mesh->steps);
    rtcSetGeometryUserData(geometry.get(), &segments);
    rtcSetGeometryBoundsFunction(geometry.get(), &bounds_of_segment, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), &intersect_segment);
    rtcSetGeometryOccludedFunction(geometry.get(), &occlude_segment);
    return geometry;
}

}  // namespace dg::embree
