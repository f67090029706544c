// footprint.h -- what a ray's cone covers of a triangle.
#pragma once
#include "scene/instance_record.h"

namespace dg {

/// Sets hit.footprint from the width (m) of the cone across the ray at the hit; needs ng, wo.
/// Nothing happens where the instance has no texture coordinates that are looked at.
void set_footprint(const InstanceRecord& record, const Placement& placement, float width,
                   SurfaceHit& hit);

/// Mean curvature (1/m) that the vertex normals of a triangle tell of; positive: bulges
/// toward the front.
float mean_curvature(const InstanceRecord& record, const Placement& placement,
                     std::uint32_t primitive);

}  // namespace dg
