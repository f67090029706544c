// across.h -- axes across a direction.
#pragma once
#include <algorithm>

#include "math/vec.h"

namespace dg {

/// They turn with a unit direction from straight ahead (-z) without a jump but straight behind.
struct Across {
    Vec3d x, y;
    explicit Across(Vec3d e) {
        const double k = 1 / std::max(1 - e.z, 1e-9);
        x = {1 - k * e.x * e.x, -k * e.x * e.y, e.x};
        y = {-k * e.x * e.y, 1 - k * e.y * e.y, e.y};
    }
};

}  // namespace dg
