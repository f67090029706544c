// near_clip.h -- the near clipping plane of a camera: what lies nearer is not in its view, neither sharp nor blurred.
// Light is none of its affair: what is clipped still casts shadows and is seen in mirrors. Camera frame, m.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace dg {

struct NearClip {
    double distance_m = 0;   // of the plane across the axis, from the origin; 0: nothing is clipped
    bool round = false;      // a ball of that radius instead, for lenses that see to the side and behind

    /// Where a ray (unit direction) comes out of what is clipped, m from its start; 0 where it starts outside. A ray
    /// that goes sideways or back never leaves a plane behind.
    double end(Vec3d from, Vec3d direction) const {
        if (!(distance_m > 0)) return 0;
        return round ? end_of_ball(from, direction) : end_of_slab(from, direction);
    }

  private:
    static constexpr double kNever = 1e18;   // as is_traceable() bears it

    double end_of_slab(Vec3d from, Vec3d direction) const {
        const double left = distance_m + from.z;   // along the axis
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
