// embree_spheres.h -- visible sphere lights.
#pragma once
#include <vector>

#include "geometry/embree_device.h"
#include "geometry/mesh.h"
#include "motion/keyed.h"

namespace dg::embree {

/// Keeps a pointer to `spheres` if any moves. Embree then gets one box for the whole path of each
/// sphere, which suffices for the few spheres of a scene; hits are exact between any keys.
GeometryOwner geometry_of_spheres(Device& device, const std::vector<Keyed<Sphere>>& spheres);

}  // namespace dg::embree
