// footprint.h -- texture footprint of a ray cone on a triangle.
#pragma once
#include "scene/instance_record.h"

namespace dg {

/// Sets hit.footprint from the width (m) of the cone at the hit; reads ng and wo. No effect if the material does not
/// use the instance's texture coordinates.
void set_footprint(const InstanceRecord& record, const Placement& placement, float width,
                   SurfaceHit& hit);

/// Mean curvature (1/m) from the vertex normals of a triangle; positive if it is convex toward the front.
float mean_curvature(const InstanceRecord& record, const Placement& placement,
                     std::uint32_t primitive);

}  // namespace dg
