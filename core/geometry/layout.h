// layout.h -- selection of instances to flatten into world space; the others are traced through a
// transform.
#pragma once
#include <cstddef>
#include <vector>

#include "geometry/intersector.h"

namespace dg {

/// Largest total number of triangles of shared meshes to flatten (about 100 bytes each). Measured
/// with Embree 3.13.5 on 2.5 GHz cores, scattered objects of three meshes, million rays/s per core
/// for primary / diffuse / shadow rays:
///   0.6 M triangles: flat 8.5 / 8.2 / 8.7, instanced 7.6 / 7.4 / 8.2, build 0.12 s and 0.01 s
///   2.4 M triangles: flat 4.9 / 3.5 / 3.7, instanced 4.2 / 3.9 / 4.4, build 0.41 s and 0.01 s
/// A single flat tree is faster only while it fits the caches.
inline constexpr std::size_t kFlattenLimit = 600'000;

/// Number of triangles above which Embree builds its compact structure: for 5 million triangles 34
/// bytes each instead of 62 (94 during the build), built in 0.7 of the time, traced 15 % slower.
/// Greater than `kFlattenLimit`, so that flattened instances stay fast.
inline constexpr std::size_t kCompactLimit = 700'000;

inline bool is_identity(const Affine3f& m) {
    const Affine3f one{};
    const auto same = [](Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
    return same(m.x, one.x) && same(m.y, one.y) && same(m.z, one.z) &&
           same(m.origin, one.origin);
}

/// A flag per instance: whether its triangles are flattened into the top level. Only static
/// triangles qualify. Meshes used once are flattened unless they are large and need copied
/// vertices; shared meshes if all their instances together stay within `limit`.
std::vector<bool> choose_flattened(const std::vector<Mesh>& meshes,
                                   const std::vector<InstanceGeometry>& instances,
                                   std::size_t limit = kFlattenLimit);

/// Number of triangles in the top level.
std::size_t count_flattened(const std::vector<Mesh>& meshes,
                            const std::vector<InstanceGeometry>& instances,
                            const std::vector<bool>& flattened);

}  // namespace dg
