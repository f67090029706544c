// moving_bounds.h -- boxes that hold a moving mesh at every time, and not only at the times for which
// they were made.
//
// Trees for motion go linearly from the box at one step to the box at the next. A point of a turning
// mesh does not: it leaves the chord by at most h^2 / 8 times its largest acceleration, h being the
// time of the step. The boxes are grown by that much, with the acceleration bounded in closed form
// (x = T + R S p with T, S linear in time and R of constant speed w has |x''| <= w^2 |S p| +
// 2 w |S' p|, at right angles to the axis of R). There is no searching for extremes, so none is missed.
#pragma once
#include <vector>

#include "motion/hull.h"
#include "motion/motion.h"

namespace dg {

/// A ball, in the world.
struct Ball {
    Vec3d center;
    double radius = 0;
};

/// Time is the fraction of the scene's interval.
struct MovingBounds {
    /// At equal steps from time 0 to 1, linear between them. One box: it holds for all times.
    std::vector<Box> boxes;
    /// At equal steps likewise, but the radius of a step holds until the next.
    std::vector<Ball> balls;

    Ball ball_at(double time) const;
};

inline constexpr int kMostMotionSteps = 128;  // Embree takes 129 boxes

MovingBounds moving_bounds(const Hull& hull, const Motion& motion);

}  // namespace dg
