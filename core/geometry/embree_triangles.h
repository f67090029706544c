// embree_triangles.h -- mesh as an Embree triangle geometry.
#pragma once
#include "geometry/embree_device.h"
#include "geometry/mesh.h"
#include "math/transform.h"

namespace dg::embree {

// High quality (spatial splits) was no faster in robust mode.
inline constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;

/// In local space; shares the mesh's arrays.
GeometryOwner triangles_of(Device& device, const Mesh& mesh);

/// In world space; copies the vertices unless the transform is the identity.
GeometryOwner world_triangles_of(Device& device, const Mesh& mesh,
                                 const Affine3f& world_from_local);

}  // namespace dg::embree
