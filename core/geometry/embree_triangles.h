// embree_triangles.h -- a mesh as Embree's triangles.
#pragma once
#include "geometry/embree_device.h"
#include "geometry/mesh.h"
#include "math/transform.h"

namespace dg::embree {

// High quality (spatial splits) traced no faster in robust mode.
inline constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;

/// In the mesh's own space: its arrays are read in place.
GeometryOwner triangles_of(Device& device, const Mesh& mesh);

/// In world space: the vertices are copied, unless the transform is the identity.
GeometryOwner world_triangles_of(Device& device, const Mesh& mesh,
                                 const Affine3f& world_from_local);

}  // namespace dg::embree
