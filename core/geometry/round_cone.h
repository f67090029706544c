// round_cone.h -- convex hull of two balls: a ray enters and leaves it once.
#pragma once
#include "math/vec.h"

namespace dg {

struct RoundCone {
    Vec3d a, b;    // centres
    double ra, rb;  // radii

    /// Whether a point is inside by more than `margin`.
    bool holds(Vec3d point, double margin) const;
};

struct RoundConeCrossing {
    double t;
    double along;  // position on the axis of the touching ball: 0 on the first, 1 on the second
    Vec3d point, normal;
};
struct RoundConeCrossings {
    RoundConeCrossing of[2];
    int count = 0;  // 0 or 2, in the order of t
};
RoundConeCrossings cross_round_cone(const RoundCone& cone, Vec3d origin, Vec3d direction);

}  // namespace dg
