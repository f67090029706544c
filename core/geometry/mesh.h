// mesh.h -- triangle meshes as arrays, in their own space (m).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Empty attribute arrays mean "absent". Sizes are checked by validate().
struct Mesh {
    std::string name;
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3f> normals;                  // unit, per vertex; absent: flat shading
    std::array<std::vector<Vec2f>, 2> uv;        // two texture sets
    std::vector<std::array<float, 4>> tangents;  // xyz, w = handedness
    std::vector<std::array<float, 4>> colors;    // linear RGBA

    /// Throws Error naming mesh and element: index out of range, NaN or Inf, wrong array
    /// length.
    void validate() const;
};

/// A sphere light that rays can hit.
struct Sphere {
    Vec3f center;  // m, world
    float radius;  // m
};

}  // namespace dg
