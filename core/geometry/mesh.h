// mesh.h -- triangle meshes as arrays, in their own space (m).
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "math/shared_array.h"
#include "math/vec.h"

namespace dg {

/// Empty attribute arrays mean "absent". Sizes are checked by validate().
/// A mesh that deforms has positions, normals and tangents of several moments, one after the other:
/// equal steps over the scene's interval, and linear between them.
struct Mesh {
    std::string name;
    std::uint32_t steps = 1;  // 1: it does not deform
    SharedArray<Vec3f> positions;
    SharedArray<std::array<std::uint32_t, 3>> triangles;
    SharedArray<Vec3f> normals;                  // unit, per vertex; absent: flat shading
    std::array<SharedArray<Vec2f>, 2> uv;        // two texture sets
    SharedArray<std::array<float, 4>> tangents;  // xyz, w = handedness
    SharedArray<std::array<float, 4>> colors;    // linear RGBA

    std::size_t vertex_count() const { return positions.size() / steps; }

    /// Throws Error naming mesh and element: index out of range, NaN or Inf, wrong array
    /// length.
    void validate() const;
};

inline constexpr std::uint32_t kMostMeshSteps = 129;  // of Embree

/// A sphere light that rays can hit.
struct Sphere {
    Vec3f center;  // m, world
    float radius;  // m
};
inline Sphere blend(const Sphere& a, const Sphere& b, float share) {
    return {a.center * (1 - share) + b.center * share, a.radius * (1 - share) + b.radius * share};
}

}  // namespace dg
