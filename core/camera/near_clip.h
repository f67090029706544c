// near_clip.h -- near clipping of the camera's view. Clipped geometry still casts shadows and
// appears in reflections. Camera frame, m.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace dg {

struct NearClip {
    double distance_m = 0;   // distance of the clipping plane from the origin; 0: no clipping
    bool round = false;      // clips a ball of this radius instead, for fields of 180 degrees and more

    /// Distance along a ray (unit direction) at which it leaves the clipped region; 0 if it starts
    /// outside. Infinite for a plane that the ray does not cross.
    double end(Vec3d from, Vec3d direction) const {
        if (!(distance_m > 0)) return 0;
        return round ? end_of_ball(from, direction) : end_of_slab(from, direction);
    }

  private:
    static constexpr double kNever = 1e18;   // within the limits of is_traceable()

    double end_of_slab(Vec3d from, Vec3d direction) const {
        const double left = distance_m + from.z;   // distance to the plane along the axis
        if (!(left > 0)) return 0;
        return direction.z < 0 ? std::min(left / -direction.z, kNever) : kNever;
    }
    double end_of_ball(Vec3d from, Vec3d direction) const {
        const double along = dot(from, direction);
        const double inside = along * along + distance_m * distance_m - length_squared(from);
        return inside > 0 ? std::max(std::sqrt(inside) - along, 0.0) : 0;
    }
};

}  // namespace dg
