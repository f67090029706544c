// embree_placed.h -- instances traced through their transform, as user geometries.
//
// Embree's own instances use the box of the mesh's transformed box, which has up to three times the
// surface of the tight box for a rotated ball, so rays would enter many instances in vain.
#pragma once
#include "geometry/embree_curves.h"
#include "geometry/embree_inside.h"
#include "geometry/mesh.h"

namespace dg::embree {

/// Whether a ray (unit direction) passes near a ball: most rays that enter the box of a roundish
/// object miss it, and a nested query costs ten times as much as this test.
inline bool comes_near(const RTCRay& ray, Vec3f center, float radius_squared) {
    const Vec3f d{ray.dir_x, ray.dir_y, ray.dir_z};
    const Vec3f to = center - Vec3f{ray.org_x, ray.org_y, ray.org_z};
    const Vec3f aside = to - d * dot(to, d);
    return length_squared(aside) <= radius_squared;
}

struct WorldBounds {
    Vec3f min, max;
    Vec3f center;  // bounding sphere about the centre of the box
    float radius_squared;
};

/// Box and sphere of the transformed vertices, enlarged by the rounding errors of both transforms.
WorldBounds world_bounds(const Mesh& mesh, const Affine3f& world_from_local);

/// Mesh with a static transform: user data of the callbacks.
struct PlacedMesh {
    RTCScene scene;    // of the mesh, in local space
    std::uint32_t id;  // of the instance
    Affine3f local_from_world;
    WorldBounds world;
    const TracedCurves* curves = nullptr;  // of the mesh; null: triangles

    bool near(const RTCRay& ray) const {
        return comes_near(ray, world.center, world.radius_squared);
    }
    RTCRay to_local(const RTCRay& ray) const { return transformed(ray, local_from_world); }
    unsigned steps() const { return 1; }
    void bounds(unsigned, RTCBounds& out) const { set_bounds(out, world.min, world.max); }
};

}  // namespace dg::embree
