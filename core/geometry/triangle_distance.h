// triangle_distance.h -- distance between two triangles in space.
#pragma once
#include <array>

#include "math/vec.h"

namespace dg {

using Triangle3d = std::array<Vec3d, 3>;

/// Distance from a point to a triangle, which may be degenerate.
double distance(Vec3d point, const Triangle3d& triangle);

/// Distance between two triangles; 0 if they intersect.
double distance(const Triangle3d& a, const Triangle3d& b);

}  // namespace dg
