// view_cone.h -- conservative bounds of a lens's field of view, for choosing emitters.
#pragma once
#include <cmath>

#include "math/vec.h"

namespace dg {

/// Position of a lens at a time: all of its rays pass within `radius` of the eye.
struct Viewpoint {
    Vec3f eye;          // m
    float radius = 0;   // m
};

/// Viewpoint and directions within `half_angle` of the axis.
struct ViewCone {
    Viewpoint from;
    float time = 0;           // fraction of the scene's interval
    Vec3f axis{0, 0, -1};     // unit
    float half_angle = kPi;   // rad

    /// Whether a ray of the lens may hit the ball. Never false where one does.
    bool sees(Vec3f center, float radius) const {
        const Vec3f to = center - from.eye;
        const float d = length(to), reach = radius + from.radius;
        return d <= reach || sees_direction(to * (1 / d), asin(reach / d));
    }
    /// Whether one goes within `spread` (rad) of a direction.
    bool sees_direction(Vec3f direction, float spread = 0) const {
        const float angle = half_angle + spread;
        return angle >= kPi || dot(direction, axis) >= std::cos(angle) - 1e-6f;
    }
};

}  // namespace dg
