// mesh.h -- triangle meshes and curves as arrays in local space (m).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "geometry/curves.h"
#include "math/shared_array.h"
#include "math/transform.h"
#include "math/vec.h"

namespace dg {

/// Empty attribute arrays mean "absent"; validate() checks sizes. A deforming mesh has positions,
/// normals and tangents for several time steps in sequence, equally spaced over the scene's
/// interval and linear in between.
struct Mesh {
    std::string name;
    std::uint32_t steps = 1;  // 1: static
    SharedArray<Vec3f> positions;
    SharedArray<std::array<std::uint32_t, 3>> triangles;
    SharedArray<Vec3f> normals;                  // unit, per vertex; absent: flat shading
    std::array<SharedArray<Vec2f>, 2> uv;        // two texture sets
    SharedArray<std::array<float, 4>> tangents;  // xyz, w = handedness
    SharedArray<std::array<float, 4>> colors;    // linear RGBA

    Curves curves;  // in place of triangles

    std::size_t vertex_count() const { return positions.size() / steps; }
    bool empty() const { return triangles.empty() && curves.empty(); }

    /// Throws Error with mesh and element for indices out of range, NaN or Inf, and wrong array
    /// lengths.
    void validate() const;
};

inline constexpr std::uint32_t kMostMeshSteps = 129;  // limit of Embree

/// Largest extent of the surface beyond the positions along each world axis; 0 for triangles.
Vec3f reach_around(const Mesh& mesh, const Affine3f& world_from_local);

/// Time step, and interpolation weight of the next.
struct MeshStep {
    std::uint32_t index;
    float share;
};
/// Step and weight at a time (0 to 1); in single precision like the ray tracer.
inline MeshStep step_at(std::uint32_t steps, float time) {
    if (steps == 1) return {0, 0};
    const float along = time * float(steps - 1);
    const float step = std::clamp(std::floor(along), 0.f, float(steps - 2));
    return {std::uint32_t(step), along - step};
}

/// Visible sphere light.
struct Sphere {
    Vec3f center;  // m, world
    float radius;  // m
};
inline Sphere blend(const Sphere& a, const Sphere& b, float share) {
    return {a.center * (1 - share) + b.center * share, a.radius * (1 - share) + b.radius * share};
}

}  // namespace dg
