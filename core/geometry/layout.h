// layout.h -- which instances are copied into world space, and which are traced through a
// transform.
#pragma once
#include <cstddef>
#include <vector>

#include "geometry/intersector.h"

namespace dg {

/// Triangles of shared meshes that may be copied into world space in all (about 100 bytes
/// each). Measured with Embree 3.13.5 on 2.5 GHz cores, scattered objects of three
/// meshes, million rays/s per core as primary / diffuse / shadow rays:
///   0.6 M triangles: flat 8.5 / 8.2 / 8.7, instanced 7.6 / 7.4 / 8.2, build 0.12 s and
///   0.01 s 2.4 M triangles: flat 4.9 / 3.5 / 3.7, instanced 4.2 / 3.9 / 4.4, build 0.41
///   s and 0.01 s
/// One flat tree is better only as long as it fits the caches.
inline constexpr std::size_t kFlattenLimit = 600'000;

/// One flag per instance: true where its triangles go into the top level in world space.
/// Meshes used once always do (it costs no memory); shared ones if all their instances
/// together stay within `limit`.
std::vector<bool> choose_flattened(const std::vector<Mesh>& meshes,
                                   const std::vector<InstanceGeometry>& instances,
                                   std::size_t limit = kFlattenLimit);

}  // namespace dg
