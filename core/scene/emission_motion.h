// emission_motion.h -- emissive triangles that move or are hidden at times.
#pragma once
#include "light/light.h"
#include "scene/instance_record.h"

namespace dg {

/// Moves a triangle of the instance to its position at a time. False: it is hidden.
bool place(const InstanceRecord& record, TriangleLight& light, float time);

/// Adds the bounds of lights[first ...], which are triangles of an instance of `mesh`.
void bound_moving_triangles(const InstanceRecord& record, const Mesh& mesh,
                            const std::vector<Light>& lights, std::size_t first,
                            LightMotion& motion);

}  // namespace dg
