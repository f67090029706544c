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

/// Above so many triangles in one structure Embree shall build its compact one: with 5 million
/// triangles 34 bytes each instead of 62 (94 while it builds), built in 0.7 of the time, traced
/// 15 % slower. Above `kFlattenLimit`, so that copies in world space stay fast.
inline constexpr std::size_t kCompactLimit = 700'000;

inline bool is_identity(const Affine3f& m) {
    const Affine3f one{};
    const auto same = [](Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
    return same(m.x, one.x) && same(m.y, one.y) && same(m.z, one.z) &&
           same(m.origin, one.origin);
}

/// One flag per instance: true where its triangles go into the top level in world space.
/// Only triangles that stand still. Meshes used once do, unless they are large and their vertices would have to be copied; shared
/// ones if all their instances together stay within `limit`.
std::vector<bool> choose_flattened(const std::vector<Mesh>& meshes,
                                   const std::vector<InstanceGeometry>& instances,
                                   std::size_t limit = kFlattenLimit);

/// Triangles in the top level.
std::size_t count_flattened(const std::vector<Mesh>& meshes,
                            const std::vector<InstanceGeometry>& instances,
                            const std::vector<bool>& flattened);

}  // namespace dg
