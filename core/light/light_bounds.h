// light_bounds.h -- where a light may shine, and bounds of several together.
#pragma once
#include "math/vec.h"

namespace dg {

/// Where a light (or a group) is and where it may shine: a box, and directions within
/// `spread` of the axis, from which emission goes on for `falloff` (weakened by the
/// cosine) and is 0 beyond.
struct LightBounds {
    Vec3f min, max;           // m
    Vec3f axis{0, 0, 1};      // unit
    float spread = kPi;       // rad; pi: all around
    float falloff = kPi / 2;  // rad
    float intensity = 0;      // cd, largest over the directions
    bool two_sided = false;   // shines along -axis as well
};

/// Bounds of both.
LightBounds merge(const LightBounds& a, const LightBounds& b);

}  // namespace dg
