// emission_motion.h -- emissive triangles that move, or are there for a time only.
#pragma once
#include "light/light.h"
#include "scene/instance_record.h"

namespace dg {

/// Puts a triangle of the instance where it is at a time. False: it is not there then.
bool place(const InstanceRecord& record, TriangleLight& light, float time);

/// Adds the bounds of lights[first ...], all of them triangles of one instance of `mesh`.
void bound_moving_triangles(const InstanceRecord& record, const Mesh& mesh,
                            const std::vector<Light>& lights, std::size_t first,
                            LightMotion& motion);

}  // namespace dg
