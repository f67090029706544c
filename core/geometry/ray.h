// ray.h -- a ray in the world (m) at one instant.
#pragma once
#include <limits>

#include "geometry/ray_cone.h"
#include "math/vec.h"

namespace dg {

struct Ray {
    Vec3f origin;     // m
    Vec3f direction;  // unit
    float time = 0;   // fraction of the scene's interval; kept by all that descend from a camera ray
    float t_min = 0;  // m
    float t_max = std::numeric_limits<float>::infinity();
    RayCone cone = {};  // about the ray; empty: no texture is averaged
};

}  // namespace dg
