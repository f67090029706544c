// instance_record.h -- what the loop needs to know of an instance, in one place, and how
// a hit becomes a surface point.
#pragma once
#include "geometry/hit.h"
#include "geometry/intersector.h"
#include "material/material.h"

namespace dg {

/// Where an instance is at one time, in which of its shapes, and how exact points on it are.
struct Placement {
    Affine3d world_from_local;
    Affine3d normal_matrix;  // linear part only; keeps the side also when mirrored
    bool mirrored;           // determinant < 0
    // Error bound of positions: error_scale * largest |coordinate| in the mesh's space of
    // the triangle + error_base.
    float error_scale, error_base;
    // For a mesh that deforms: where the arrays of the step begin, and the share of the next step.
    std::size_t first_vertex = 0;
    float step_share = 0;
};

/// Room for one; nothing is cleared first (an optional is, by gcc: bug 86173).
struct PlacementRoom {
    union {
        Placement placement;
    };
    PlacementRoom() {}  // NOLINT: left as it is
};

struct InstanceRecord {
    const Mesh* curves;  // of an instance of curves (curve_surface.h); null: triangles
    const Vec3f* positions;
    const std::array<std::uint32_t, 3>* triangles;
    // Null where the mesh has none, or where its material does not look at them.
    const Vec3f* normals;
    const Vec2f* uv[2];
    const Vec2f* tangent_uv;  // the set whose +u is the tangent
    const std::array<float, 4>* tangents;
    const std::array<float, 4>* colors;
    std::uint32_t material;
    std::uint32_t steps;               // of the mesh
    std::size_t vertex_count;
    bool needs_frame;  // a normal map or anisotropy wants a tangent
    bool textured;     // the material looks at textures
    bool mixed;        // a mixture: hits choose a part
    Placement still;   // of what neither moves nor deforms
    const Motion* motion = nullptr;  // over the scene's interval; null: stands still
    const Shown* shown = nullptr;    // null: always

    bool is_shown(float time) const { return !shown || shown->at(time); }
    Placement at(float time) const;
    /// The same, with no more than corners_at() needs: neither normals nor errors.
    Placement where(float time) const;
    void set_step(Placement& placement, float time) const;
    bool changes() const { return motion || steps > 1; }
    bool moves() const { return changes() || shown; }

    Vec3d position(const Placement& p, std::uint32_t vertex) const {
        const Vec3f* now = positions + p.first_vertex + vertex;
        if (p.step_share == 0) return to_double(*now);
        const Vec3d a = to_double(*now), b = to_double(now[vertex_count]);
        return a * (1 - double(p.step_share)) + b * double(p.step_share);
    }
    Vec3f normal(const Placement& p, std::uint32_t vertex) const {
        const Vec3f* now = normals + p.first_vertex + vertex;
        if (p.step_share == 0) return *now;
        return *now * (1 - p.step_share) + now[vertex_count] * p.step_share;
    }

    /// That of a time. What stands still pays nothing; for all else `made` keeps it.
    const Placement& placement(float time, PlacementRoom& made) const {
        return changes() ? (made.placement = at(time)) : still;
    }
};

/// `flattened`: see Intersector::is_flattened. Keeps pointers into all but `geometry`.
InstanceRecord make_record(const Mesh& mesh, const Material& material,
                           std::uint32_t material_index, const InstanceGeometry& geometry,
                           bool flattened);

/// The corners of a triangle in the world, where the instance is placed so.
std::array<Vec3f, 3> corners_at(const InstanceRecord& record, const Placement& placement,
                                std::uint32_t primitive);

/// A point of a triangle, or of a curve, in the world, in double.
Vec3d point_at(const InstanceRecord& record, std::uint32_t primitive, float u, float v, float time);

/// Texture coordinates and colour at barycentrics (u, v) of a triangle, or a place of a curve.
void interpolate_attributes(const InstanceRecord& record, std::uint32_t primitive,
                            float u, float v, SurfaceHit& hit);

/// Everything of the hit but wo, t, time, instance and front; of curves, `hit.time` is read.
void surface_at(const InstanceRecord& record, const Placement& placement,
                std::uint32_t primitive, float u, float v, SurfaceHit& hit);

}  // namespace dg
