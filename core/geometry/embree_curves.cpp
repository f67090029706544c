#include "geometry/embree_curves.h"

#include <algorithm>
#include <cmath>

#include "geometry/embree_triangles.h"

namespace dg::embree {
namespace {

constexpr unsigned kCapGeometry = 1;
constexpr int kMostBits = 30, kMostShift = 40;

/// Power of two that scales the largest radius to 1 .. 2, or less if coordinates would become too
/// large.
float scale_for(const Mesh& mesh) {
    const float radius = mesh.curves.largest_radius();
    float most = radius;
    for (const Vec3f p : mesh.positions)
        most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!(radius > 0)) return 1;
    const int to_one = std::clamp(-std::ilogb(radius), -kMostShift, kMostShift);
    return std::exp2(float(std::min(to_one, kMostBits - std::ilogb(most))));
}

struct Vertex {
    float x, y, z, radius;
};

/// Scaled vertex. Embree squares and divides by distances, so values that are negligible relative
/// to the largest radius are flushed to 0.
Vertex vertex_at(Vec3f p, float radius, float scale) {
    const auto in_units = [scale](float v) {
        constexpr float kNothing = 0x1p-30f;
        return std::abs(v * scale) < kNothing ? 0 : v * scale;
    };
    return {in_units(p.x), in_units(p.y), in_units(p.z), in_units(radius)};
}

/// Outward normal of a cap, unnormalized: the derivative is linear between time steps, a unit
/// vector is not.
Vec3f cap_normal(const CurveSegment& s, double u, float scale) {
    const Vec3f d = to_float(s.derivative(u)) * scale;
    const Vec3f along = length_squared(d) > 1e-20f ? d : to_float(s.tangent(u));
    return u == 0 ? -along : along;
}

}  // namespace

TracedCurves::TracedCurves(const Mesh& mesh) : mesh_(&mesh), scale_(scale_for(mesh)) {
    const Curves& c = mesh.curves;
    if (!c.cubic || c.closed) return;
    for (std::uint32_t s = 0; s < c.starts.size(); ++s) {
        if (c.begins_curve(s) && c.radii[c.starts[s]] > 0) caps_.push_back({s, false});
        if (c.ends_curve(s) && c.radii[c.starts[s] + 3] > 0) caps_.push_back({s, true});
    }
}

GeometryOwner TracedCurves::segments(Device& device) const {
    const Curves& c = mesh_->curves;
    GeometryOwner geometry = device.new_geometry(
        RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE, "curves '" + mesh_->name + "'");
    rtcSetGeometryBuildQuality(geometry.get(), kBuildQuality);
    rtcSetGeometryTimeStepCount(geometry.get(), mesh_->steps);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                               c.starts.data(), 0, sizeof(std::uint32_t), c.starts.size());
    set_vertices(device, geometry.get());
    return geometry;
}

void TracedCurves::set_vertices(Device& device, RTCGeometry geometry) const {
    const std::size_t n = mesh_->vertex_count();
    for (std::uint32_t step = 0; step < mesh_->steps; ++step) {
        void* room = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step,
                                             RTC_FORMAT_FLOAT4, sizeof(Vertex), n);
        device.check("points of curves '" + mesh_->name + "'");
        auto* vertex = static_cast<Vertex*>(room);
        const Vec3f* points = mesh_->positions.data() + step * n;
        for (std::size_t i = 0; i < n; ++i)
            vertex[i] = vertex_at(points[i], mesh_->curves.radii[i], scale_);
    }
}

GeometryOwner TracedCurves::caps(Device& device) {
    if (caps_.empty()) return nullptr;
    const std::string what = "ends of curves '" + mesh_->name + "'";
    GeometryOwner geometry = device.new_geometry(RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, what);
    rtcSetGeometryTimeStepCount(geometry.get(), mesh_->steps);
    for (std::uint32_t step = 0; step < mesh_->steps; ++step) {
        auto* vertex = static_cast<Vertex*>(
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4,
                                    sizeof(Vertex), caps_.size()));
        auto* normal = static_cast<Vec3f*>(
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_NORMAL, step, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3f), caps_.size()));
        device.check(what);
        const float time = mesh_->steps == 1 ? 0 : float(step) / float(mesh_->steps - 1);
        for (const Cap& cap : caps_) {
            const CurveSegment s = segment_at(*mesh_, cap.segment, time);
            const double u = cap.at_end ? 1 : 0;
            *vertex++ = vertex_at(to_float(s.center(u)), float(s.radius(u)), scale_);
            *normal++ = cap_normal(s, u, scale_);
        }
    }
    return geometry;
}

CurvePlace TracedCurves::cap_place(const Cap& cap, const RTCRay& ray) const {
    const CurveSegment s = segment_at(*mesh_, cap.segment, ray.time);
    const Vec3d origin{ray.org_x, ray.org_y, ray.org_z}, way{ray.dir_x, ray.dir_y, ray.dir_z};
    const Vec3d met = (origin + way * double(ray.tfar)) / double(scale_);
    return place_on_cap(s, cap.at_end, met - s.center(cap.at_end ? 1 : 0));
}

void TracedCurves::set_place(const RTCRay& ray, RTCHit& hit) const {
    if (!cubic()) return;
    CurvePlace place;
    if (hit.geomID == kCapGeometry) {
        const Cap& cap = caps_[hit.primID];
        place = cap_place(cap, ray);
        hit.primID = cap.segment;
    } else {
        const Vec3d normal{hit.Ng_x, hit.Ng_y, hit.Ng_z};
        const CurveSegment s = segment_at(*mesh_, hit.primID, ray.time);
        place = place_of(s, hit.u, normal);
    }
    hit.u = place.along, hit.v = place.around;
}

}  // namespace dg::embree
