// layout.h -- which instances are copied into world space, and which are traced through a transform.
#pragma once
#include <cstddef>
#include <vector>

#include "geometry/intersector.h"

namespace dg {

/// Triangles that may be copied into world space in all. Measured on a field of 200 objects of three
/// meshes (2.37 M triangles, 2 cores, bench figures in layout.cpp).
inline constexpr std::size_t kFlattenLimit = 4'000'000;

/// One flag per instance: true where its triangles go into the top level in world space. Meshes used
/// once always do (it costs no memory); shared ones while the total stays under `limit`, smallest
/// copies first.
std::vector<bool> choose_flattened(const std::vector<Mesh>& meshes,
                                   const std::vector<InstanceGeometry>& instances,
                                   std::size_t limit = kFlattenLimit);

}  // namespace dg
