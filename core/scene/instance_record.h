// instance_record.h -- per-instance data for rendering, and the conversion of a hit to a surface point.
#pragma once
#include "geometry/hit.h"
#include "geometry/intersector.h"
#include "material/material.h"

namespace dg {

/// Transform, shape and position error of an instance at a time.
struct Placement {
    Affine3d world_from_local;
    Affine3d normal_matrix;  // linear part only; preserves the side of mirrored instances
    bool mirrored;           // determinant < 0
    // Error bound of positions: error_scale * largest |coordinate| in the mesh's space of
    // the triangle + error_base.
    float error_scale, error_base;
    // For a deforming mesh: index of the step's first vertex, and interpolation weight of the next step.
    std::size_t first_vertex = 0;
    float step_share = 0;
};

/// Uninitialized storage for a Placement (gcc zeroes an optional: bug 86173).
struct PlacementRoom {
    union {
        Placement placement;
    };
    PlacementRoom() {}  // NOLINT: uninitialized
};

struct InstanceRecord {
    const Mesh* curves;  // mesh of curves (curve_surface.h); null: triangles
    const Vec3f* positions;
    const std::array<std::uint32_t, 3>* triangles;
    // Attributes, null if the mesh has none or its material does not use them.
    const Vec3f* normals;
    const Vec2f* uv[2];
    const Vec2f* tangent_uv;  // texture coordinate set that defines the tangent (+u)
    const std::array<float, 4>* tangents;
    const std::array<float, 4>* colors;
    std::uint32_t material;
    std::uint32_t steps;               // of the mesh
    std::size_t vertex_count;
    bool needs_frame;  // a normal map or anisotropy needs a tangent
    bool textured;     // the material uses textures
    bool mixed;        // a mixture: hits choose a part
    bool smooth;       // vertex normals, and a material that only reflects
    Placement still;   // for instances that neither move nor deform
    const Motion* motion = nullptr;  // over the scene's interval; null: static
    const Shown* shown = nullptr;    // null: always

    bool is_shown(float time) const { return !shown || shown->at(time); }
    Placement at(float time) const;
    /// Placement with the data that corners_at() needs, without normals and errors.
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
    /// Unit normal in the instance's space, also between steps.
    Vec3f normal(const Placement& p, std::uint32_t vertex) const {
        const Vec3f* now = normals + p.first_vertex + vertex;
        if (p.step_share == 0) return *now;
        const Vec3f mixed = *now * (1 - p.step_share) + now[vertex_count] * p.step_share;
        const float l2 = length_squared(mixed);
        return l2 > 1e-30f ? mixed * (1 / std::sqrt(l2)) : *now;
    }

    /// Tangent in the instance's space, not normalized.
    Vec3f tangent(const Placement& p, std::uint32_t vertex) const {
        const auto* now = tangents + p.first_vertex + vertex;
        const auto vector = [](const std::array<float, 4>& t) { return Vec3f{t[0], t[1], t[2]}; };
        if (p.step_share == 0) return vector(*now);
        return vector(*now) * (1 - p.step_share) + vector(now[vertex_count]) * p.step_share;
    }

    /// Placement at a time, without a copy for static instances; otherwise stored in `made`.
    const Placement& placement(float time, PlacementRoom& made) const {
        return changes() ? (made.placement = at(time)) : still;
    }
};

/// `flattened`: see Intersector::is_flattened. The record keeps pointers into all arguments except `geometry`.
InstanceRecord make_record(const Mesh& mesh, const Material& material,
                           std::uint32_t material_index, const InstanceGeometry& geometry,
                           bool flattened);

/// The corners of a triangle in the world, for a placement.
std::array<Vec3f, 3> corners_at(const InstanceRecord& record, const Placement& placement,
                                std::uint32_t primitive);

/// A point of a triangle, or of a curve, in the world, in double.
Vec3d point_at(const InstanceRecord& record, std::uint32_t primitive, float u, float v, float time);

/// Texture coordinates and colour at barycentrics (u, v) of a triangle, or at a position on a curve.
void interpolate_attributes(const InstanceRecord& record, std::uint32_t primitive,
                            float u, float v, SurfaceHit& hit);

/// Sets all fields of the hit except wo, t, time, instance and front; reads `hit.time` for curves.
void surface_at(const InstanceRecord& record, const Placement& placement,
                std::uint32_t primitive, float u, float v, SurfaceHit& hit);

}  // namespace dg
