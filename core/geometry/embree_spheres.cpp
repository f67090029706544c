#include "geometry/embree_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dg::embree {
namespace {

using Spheres = std::vector<Keyed<Sphere>>;

/// Centre and radius, and therefore the box, are linear between two keys.
void bounds_of_sphere(const RTCBoundsFunctionArguments* a) {
    const auto& keys = (*static_cast<const Spheres*>(a->geometryUserPtr))[a->primID];
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Vec3f low{kInfinity, kInfinity, kInfinity}, high = -low;
    for (const Sphere& s : keys.values) {
        for (int k = 0; k < 3; ++k) {
            const float slack = 4 * 0x1p-24f * (std::abs(s.center[k]) + s.radius);
            low[k] = std::min(low[k], s.center[k] - s.radius - slack);
            high[k] = std::max(high[k], s.center[k] + s.radius + slack);
        }
    }
    RTCBounds& out = *a->bounds_o;
    out.lower_x = low.x, out.lower_y = low.y, out.lower_z = low.z;
    out.upper_x = high.x, out.upper_y = high.y, out.upper_z = high.z;
}

/// Distance along a unit direction to the entry point on the sphere, or to the exit from inside;
/// infinity outside the ray's interval.
float distance_to(const Sphere& sphere, const RTCRay& ray) {
    const Vec3d d{ray.dir_x, ray.dir_y, ray.dir_z};
    const Vec3d to = to_double(sphere.center) - Vec3d{ray.org_x, ray.org_y, ray.org_z};
    const double along = dot(to, d), radius = sphere.radius;
    const double half2 = radius * radius - length_squared(to - d * along);
    if (!(half2 > 0)) return std::numeric_limits<float>::infinity();
    for (const double t : {along - std::sqrt(half2), along + std::sqrt(half2)})
        if (t > ray.tnear && t < ray.tfar) return float(t);
    return std::numeric_limits<float>::infinity();
}

Sphere sphere_at(const void* spheres, unsigned primitive, float time) {
    return (*static_cast<const Spheres*>(spheres))[primitive].at(time);
}

// Only single rays are traced, so N is 1 and the packets are plain structures.
void intersect_sphere(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    auto& world = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    const float t = distance_to(sphere_at(a->geometryUserPtr, a->primID, world.ray.time), world.ray);
    if (t == std::numeric_limits<float>::infinity()) return;
    world.ray.tfar = t;
    world.hit.u = world.hit.v = 0;
    world.hit.geomID = a->geomID;
    world.hit.primID = a->primID;
    world.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

void occlude_sphere(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
    const float t = distance_to(sphere_at(a->geometryUserPtr, a->primID, ray.time), ray);
    if (t < std::numeric_limits<float>::infinity())
        ray.tfar = -std::numeric_limits<float>::infinity();
}

GeometryOwner moving(Device& device, const Spheres& spheres) {
    GeometryOwner geometry = device.new_geometry(RTC_GEOMETRY_TYPE_USER, "sphere lights");
    rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(spheres.size()));
    rtcSetGeometryUserData(geometry.get(), const_cast<Spheres*>(&spheres));
    rtcSetGeometryBoundsFunction(geometry.get(), &bounds_of_sphere, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), &intersect_sphere);
    rtcSetGeometryOccludedFunction(geometry.get(), &occlude_sphere);
    return geometry;
}

}  // namespace

GeometryOwner geometry_of_spheres(Device& device, const Spheres& spheres) {
    if (std::ranges::any_of(spheres, &Keyed<Sphere>::moves)) return moving(device, spheres);
    static_assert(sizeof(Sphere) == 16, "read in place as x, y, z, radius");
    GeometryOwner geometry =
        device.new_geometry(RTC_GEOMETRY_TYPE_SPHERE_POINT, "sphere lights");
    void* copy =
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                RTC_FORMAT_FLOAT4, sizeof(Sphere), spheres.size());
    device.check("sphere lights");
    auto* still = static_cast<Sphere*>(copy);
    for (const Keyed<Sphere>& s : spheres) *still++ = s.values.front();
    return geometry;
}

}  // namespace dg::embree
