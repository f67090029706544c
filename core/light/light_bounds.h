// light_bounds.h -- bounds of lights in position, direction and intensity.
#pragma once
#include "math/vec.h"

namespace dg {

/// Bounds of a light or a group: a box, and a cone of normals of half angle `spread` around the axis. Emission extends
/// beyond the normals by the angle `falloff`, with a cosine falloff, and is 0 outside.
struct LightBounds {
    Vec3f min, max;           // m
    Vec3f axis{0, 0, 1};      // unit
    float spread = kPi;       // rad; pi: all directions
    float falloff = kPi / 2;  // rad
    float intensity = 0;      // cd, maximum over directions
    bool two_sided = false;   // also emits along -axis
};

/// Union of bounds.
LightBounds merge(const LightBounds& a, const LightBounds& b);

}  // namespace dg
