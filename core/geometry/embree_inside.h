// embree_inside.h -- user geometries with a single primitive: a mesh traced in local space.
#pragma once
#include <cmath>

#include "geometry/embree_curves.h"

namespace dg::embree {

inline void set_bounds(RTCBounds& out, Vec3f min, Vec3f max) {
    out.lower_x = min.x, out.lower_y = min.y, out.lower_z = min.z;
    out.upper_x = max.x, out.upper_y = max.y, out.upper_z = max.z;
}

template <typename Real>
RTCRay transformed(const RTCRay& ray, const Affine<Real>& m) {
    const Vec3<Real> o = m.point({ray.org_x, ray.org_y, ray.org_z});
    const Vec3<Real> d = m.vector({ray.dir_x, ray.dir_y, ray.dir_z});
    RTCRay local = ray;  // t is equal in both spaces, as d is not normalized
    local.org_x = float(o.x), local.org_y = float(o.y), local.org_z = float(o.z);
    local.dir_x = float(d.x), local.dir_y = float(d.y), local.dir_z = float(d.z);
    return local;
}

/// Other rays must not reach Embree, since its arithmetic overflows.
inline bool is_traceable(const RTCRay& ray) {
    return dg::is_traceable({ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}) &&
           !std::isnan(ray.tnear) && !std::isnan(ray.tfar);
}

/// Context of a nested query, with the instance's id for hits and filters.
inline Context inside(std::uint32_t id, const void* outer) {
    Context context;
    init_context(context.embree);
    context.embree.instID[0] = id;
    context.ray = static_cast<const Context*>(outer)->ray;
    context.crossings = static_cast<const Context*>(outer)->crossings;
    return context;
}

// The functions below are templates on `Placed`, which provides RTCScene scene; std::uint32_t id;
// const TracedCurves* curves; bool near(const RTCRay&); RTCRay to_local(const RTCRay&); void
// bounds(unsigned step, RTCBounds&); unsigned steps(). Rays that are not traceable in local space
// miss: the transform is singular at their time, or its scale exceeds the range of float. Rays are
// traced singly, so N is 1 and the packets are plain structures.

template <typename Placed>
void bounds_of(const RTCBoundsFunctionArguments* a) {
    static_cast<const Placed*>(a->geometryUserPtr)->bounds(a->timeStep, *a->bounds_o);
}

template <typename Placed>
void intersect_inside(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& placed = *static_cast<const Placed*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    if (!placed.near(world.ray)) return;
    Context context = inside(placed.id, a->context);
    RTCRayHit local;
    local.ray = placed.to_local(world.ray);
    if (placed.curves) placed.curves->scale(local.ray);
    if (!is_traceable(local.ray)) return;
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query(placed.scene, context.embree, local);
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    if (placed.curves) placed.curves->set_place(local.ray, local.hit);
    world.ray.tfar = local.ray.tfar;
    world.hit = local.hit;
    world.hit.instID[0] = placed.id;
}

template <typename Placed>
void occlude_inside(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& placed = *static_cast<const Placed*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRay*>(a->ray);
    if (!placed.near(world)) return;
    Context context = inside(placed.id, a->context);
    RTCRay local = placed.to_local(world);
    if (placed.curves) placed.curves->scale(local);
    if (!is_traceable(local)) return;
    query(placed.scene, context.embree, local);
    if (local.tfar < 0) world.tfar = local.tfar;
}

/// Keeps a pointer to `placed`.
template <typename Placed>
GeometryOwner geometry_of(Device& device, Placed& placed) {
    GeometryOwner geometry =
        device.new_geometry(RTC_GEOMETRY_TYPE_USER, "instance of a mesh");
    rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
    rtcSetGeometryTimeStepCount(geometry.get(), placed.steps());
    rtcSetGeometryUserData(geometry.get(), &placed);
    rtcSetGeometryBoundsFunction(geometry.get(), &bounds_of<Placed>, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), &intersect_inside<Placed>);
    rtcSetGeometryOccludedFunction(geometry.get(), &occlude_inside<Placed>);
    return geometry;
}

}  // namespace dg::embree
