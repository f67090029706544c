// round_cone.h -- the hull of two balls, which is convex: a ray goes in once and out once.
#pragma once
#include "math/vec.h"

namespace dg {

struct RoundCone {
    Vec3d a, b;    // centres
    double ra, rb;  // radii

    /// Whether a point lies inside by more than `margin`.
    bool holds(Vec3d point, double margin) const;
};

struct RoundConeCrossing {
    double t;
    double along;  // place on the axis of the ball that touches here: 0 on the first, 1 on the second
    Vec3d point, normal;
};
struct RoundConeCrossings {
    RoundConeCrossing of[2];
    int count = 0;  // 0 or 2, in the order of t
};
RoundConeCrossings cross_round_cone(const RoundCone& cone, Vec3d origin, Vec3d direction);

}  // namespace dg
