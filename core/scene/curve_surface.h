// curve_surface.h -- from segment and place on a round curve to position, normals, frame, attributes.
// The texture coordinates that curves have of their own run along the whole curve and around it, each
// from 0 to 1: they are set 1, and set 0 where the mesh brings none.
#pragma once
#include "scene/instance_record.h"

namespace dg {

/// Does for a curve what surface_at() does for a triangle, at hit.time.
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

/// A piece of surface as two edges (m, world) and what the texture coordinates grow by along them.
struct TexturedPatch {
    Vec3f edge[2];
    std::array<std::array<Vec2f, 2>, 2> uv;  // by set, then by edge
};
TexturedPatch curve_patch(const InstanceRecord& record, const Placement& placement,
                          std::uint32_t segment, const SurfaceHit& hit);

}  // namespace dg
