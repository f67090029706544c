// embree_placed.cpp -- bounds of placed meshes, and rays taken into their space.
#include "geometry/embree_placed.h"

#include <limits>

namespace dg::embree {

WorldBounds world_bounds(const Mesh& mesh, const Affine3f& world_from_local) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    WorldBounds b{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, {}, 0};
    float largest = 0;
    for (const Vec3f& p : mesh.positions) {
        const Vec3f q = world_from_local.point(p);
        for (int k = 0; k < 3; ++k) {
            b.min[k] = std::min(b.min[k], q[k]);
            b.max[k] = std::max(b.max[k], q[k]);
            largest = std::max(largest, std::abs(q[k]));
        }
    }
    const float slack = 16 * 0x1p-24f * largest;
    const Vec3f grow{slack, slack, slack};
    b.min = b.min - grow;
    b.max = b.max + grow;
    b.center = (b.min + b.max) * 0.5f;
    for (const Vec3f& p : mesh.positions) {
        const float r2 = length_squared(world_from_local.point(p) - b.center);
        b.radius_squared = std::max(b.radius_squared, r2);
    }
    const float radius = 1.0001f * std::sqrt(b.radius_squared) + 4 * slack;
    b.radius_squared = radius * radius;
    return b;
}

namespace {

RTCRay to_local(const PlacedMesh& placed, const RTCRay& ray) {
    const Vec3f o = placed.local_from_world.point({ray.org_x, ray.org_y, ray.org_z});
    const Vec3f d = placed.local_from_world.vector({ray.dir_x, ray.dir_y, ray.dir_z});
    RTCRay local = ray;  // t is the same in both spaces, as d is not normalised
    local.org_x = o.x, local.org_y = o.y, local.org_z = o.z;
    local.dir_x = d.x, local.dir_y = d.y, local.dir_z = d.z;
    return local;
}

/// The context of a query inside, which tells hits and filters the instance.
Context inside(const PlacedMesh& placed, const void* outer) {
    Context context;
    init_context(context.embree);
    context.embree.instID[0] = placed.id;
    context.ray = static_cast<const Context*>(outer)->ray;
    context.crossings = static_cast<const Context*>(outer)->crossings;
    return context;
}

// Only single rays are traced, so N is 1 and the packets are plain structures.
void bounds_of_placed(const RTCBoundsFunctionArguments* a) {
    const WorldBounds& b = static_cast<const PlacedMesh*>(a->geometryUserPtr)->bounds;
    RTCBounds& out = *a->bounds_o;
    out.lower_x = b.min.x, out.lower_y = b.min.y, out.lower_z = b.min.z;
    out.upper_x = b.max.x, out.upper_y = b.max.y, out.upper_z = b.max.z;
}

void intersect_placed(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& placed = *static_cast<const PlacedMesh*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    if (!placed.bounds.near(world.ray)) return;
    Context context = inside(placed, a->context);
    RTCRayHit local;
    local.ray = to_local(placed, world.ray);
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query(placed.scene, context.embree, local);
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    world.ray.tfar = local.ray.tfar;
    world.hit = local.hit;
    world.hit.instID[0] = placed.id;
}

void occlude_placed(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& placed = *static_cast<const PlacedMesh*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRay*>(a->ray);
    if (!placed.bounds.near(world)) return;
    Context context = inside(placed, a->context);
    RTCRay local = to_local(placed, world);
    query(placed.scene, context.embree, local);
    if (local.tfar < 0) world.tfar = local.tfar;
}

}  // namespace

GeometryOwner geometry_of(Device& device, PlacedMesh& placed) {
    GeometryOwner geometry =
        device.new_geometry(RTC_GEOMETRY_TYPE_USER, "instance of a mesh");
    rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
    rtcSetGeometryUserData(geometry.get(), &placed);
    rtcSetGeometryBoundsFunction(geometry.get(), &bounds_of_placed, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), &intersect_placed);
    rtcSetGeometryOccludedFunction(geometry.get(), &occlude_placed);
    return geometry;
}

}  // namespace dg::embree
