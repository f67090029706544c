// instance_bounds.h -- boxes around instances in the scene's frame.
#pragma once
#include "geometry/bounds.h"

namespace dg {

struct Instance;
struct Mesh;

/// Box of the vertices and curves of an instance that does not move.
Bounds bounds_of_still(const Mesh& mesh, const Instance& instance);

/// Box around all places of an instance; of one that moves, from the corners of its mesh's own box. For use before there
/// is a ray tracer, which has closer boxes of moving instances.
Bounds bounds_over_time(const Mesh& mesh, const Instance& instance);

}  // namespace dg
