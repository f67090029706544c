// curve_surface.h -- position, normals, frame and attributes at a hit on a round curve. Curves have default texture
// coordinates from 0 to 1 along the curve and around it: these are set 1, and also set 0 if the mesh has none.
#pragma once
#include "scene/instance_record.h"

namespace dg {

/// The counterpart of surface_at() for curves, at hit.time.
void curve_surface_at(const InstanceRecord& record, const Placement& placement,
                      std::uint32_t segment, CurvePlace place, SurfaceHit& hit);

/// Sets texture coordinates and colour.
void interpolate_curve(const InstanceRecord& record, std::uint32_t segment, CurvePlace place,
                       SurfaceHit& hit);

/// A point of a curve in the world.
Vec3d curve_point_at(const InstanceRecord& record, std::uint32_t segment, CurvePlace place,
                     float time);

/// Mean curvature (1/m) of a segment of the mean radius, in the world.
float curve_curvature(const InstanceRecord& record, const Placement& placement,
                      std::uint32_t segment);

/// A patch of the surface: two edges (m, world) and the differences of texture coordinates along them.
struct TexturedPatch {
    Vec3f edge[2];
    std::array<std::array<Vec2f, 2>, 2> uv;  // per set and edge
};
TexturedPatch curve_patch(const InstanceRecord& record, const Placement& placement,
                          std::uint32_t segment, const SurfaceHit& hit);

}  // namespace dg
