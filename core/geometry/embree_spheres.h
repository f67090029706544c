// embree_spheres.h -- sphere lights that rays can hit.
#pragma once
#include <vector>

#include "geometry/embree_device.h"
#include "geometry/mesh.h"
#include "motion/keyed.h"

namespace dg::embree {

/// Keeps a pointer to `spheres` if one of them moves: those Embree knows by the boxes of all their
/// way, which is enough for the few that a scene has, and they are exact between any keys.
GeometryOwner geometry_of_spheres(Device& device, const std::vector<Keyed<Sphere>>& spheres);

}  // namespace dg::embree
