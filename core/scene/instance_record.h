// instance_record.h -- what the loop needs to know of an instance, in one place, and how
// a hit becomes a surface point.
#pragma once
#include "geometry/hit.h"
#include "geometry/intersector.h"
#include "material/material.h"

namespace dg {

struct InstanceRecord {
    const Vec3f* positions;
    const std::array<std::uint32_t, 3>* triangles;
    // Null where the mesh has none, or where its material does not look at them.
    const Vec3f* normals;
    const Vec2f* uv[2];
    const Vec2f* tangent_uv;  // the set whose +u is the tangent
    const std::array<float, 4>* tangents;
    const std::array<float, 4>* colors;
    std::uint32_t material;
    bool mirrored;     // determinant < 0
    bool needs_frame;  // a normal map or anisotropy wants a tangent
    Affine3d world_from_local;
    Affine3d normal_matrix;  // linear part only; keeps the side also when mirrored
    // Error bound of positions: error_scale * largest |coordinate| in the mesh's space of
    // the triangle + error_base.
    float error_scale, error_base;
};

/// `flattened`: see Intersector::is_flattened.
InstanceRecord make_record(const Mesh& mesh, const Material& material,
                           std::uint32_t material_index, const Affine3f& world_from_local,
                           bool flattened);

/// Texture coordinates and colour at barycentrics (u, v) of a triangle.
void interpolate_attributes(const InstanceRecord& record, std::uint32_t primitive,
                            float u, float v, SurfaceHit& hit);

/// Everything of the hit but wo, t, instance and front.
void surface_at(const InstanceRecord& record, std::uint32_t primitive, float u, float v,
                SurfaceHit& hit);

}  // namespace dg
