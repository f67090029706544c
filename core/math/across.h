// across.h -- axes perpendicular to a direction.
#pragma once
#include <algorithm>

#include "math/vec.h"

namespace dg {

/// Orthonormal axes across a unit direction e, rotated from (x, y) together with -z: continuous
/// except at e = +z.
struct Across {
    Vec3d x, y;
    explicit Across(Vec3d e) {
        const double k = 1 / std::max(1 - e.z, 1e-9);
        x = {1 - k * e.x * e.x, -k * e.x * e.y, e.x};
        y = {-k * e.x * e.y, 1 - k * e.y * e.y, e.y};
    }
};

}  // namespace dg
