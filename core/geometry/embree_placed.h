// embree_placed.h -- instances that are traced through their transform, as user geometries.
//
// User geometries and not Embree's own instances, because those take the box of the
// transformed box of the mesh, up to three times the surface of the true one for a turned
// ball: rays enter many instances for nothing.
#pragma once
#include "geometry/embree_curves.h"
#include "geometry/embree_inside.h"
#include "geometry/mesh.h"

namespace dg::embree {

/// Whether a ray (unit direction) comes near a ball: most rays that enter the box of a roundish thing
/// pass it by, and a question to Embree costs ten times this one.
inline bool comes_near(const RTCRay& ray, Vec3f center, float radius_squared) {
    const Vec3f d{ray.dir_x, ray.dir_y, ray.dir_z};
    const Vec3f to = center - Vec3f{ray.org_x, ray.org_y, ray.org_z};
    const Vec3f aside = to - d * dot(to, d);
    return length_squared(aside) <= radius_squared;
}

struct WorldBounds {
    Vec3f min, max;
    Vec3f center;  // of the sphere around the middle of the box
    float radius_squared;
};

/// Box and sphere of the transformed vertices, grown by the rounding of the two transforms.
WorldBounds world_bounds(const Mesh& mesh, const Affine3f& world_from_local);

/// A mesh in its place; what the callbacks of a user geometry see.
struct PlacedMesh {
    RTCScene scene;    // of the mesh, in its own space
    std::uint32_t id;  // of the instance
    Affine3f local_from_world;
    WorldBounds world;
    const TracedCurves* curves = nullptr;  // of the mesh; null: it has triangles

    bool near(const RTCRay& ray) const {
        return comes_near(ray, world.center, world.radius_squared);
    }
    RTCRay to_local(const RTCRay& ray) const { return transformed(ray, local_from_world); }
    unsigned steps() const { return 1; }
    void bounds(unsigned, RTCBounds& out) const { set_bounds(out, world.min, world.max); }
};

}  // namespace dg::embree
