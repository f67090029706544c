// moving_bounds.h -- conservative bounds of moving meshes for all times.
//
// Motion trees interpolate boxes linearly between steps. A point of a rotating mesh deviates from
// its chord by at most h^2 / 8 times its largest acceleration, where h is the duration of the step,
// so the boxes are enlarged by this amount. The acceleration is bounded in closed form (x = T + R S
// p with T, S linear in time and R of constant speed w has |x''| <= w^2 |S p| + 2 w |S' p|,
// perpendicular to the axis of R), so no extreme can be missed.
#pragma once
#include <vector>

#include "motion/hull.h"
#include "motion/motion.h"

namespace dg {

/// Ball in world space.
struct Ball {
    Vec3d center;
    double radius = 0;
};

/// Bounds over time, as fractions of the scene's interval.
struct MovingBounds {
    /// At equal steps from time 0 to 1, linear in between. A single box holds for all times.
    std::vector<Box> boxes;
    /// At the same steps; the radius of a step holds until the next.
    std::vector<Ball> balls;

    Ball ball_at(double time) const;
};

inline constexpr int kMostMotionSteps = 128;  // Embree accepts 129 boxes

MovingBounds moving_bounds(const Hull& hull, const Motion& motion);

}  // namespace dg
