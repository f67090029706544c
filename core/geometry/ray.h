// ray.h -- a ray in the world (m) at one instant.
#pragma once
#include <cmath>
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
    bool of_set = false;  // meets catchers alone: the set as it is without the objects
};

/// Whether a ray tracer bears it: no NaN, nothing infinite, and nothing at which its own numbers overflow.
inline bool is_traceable(Vec3f origin, Vec3f direction) {
    return std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z) + std::abs(direction.x) +
               std::abs(direction.y) + std::abs(direction.z) <
           kFar;
}
inline bool is_traceable(const Ray& ray) { return is_traceable(ray.origin, ray.direction); }

}  // namespace dg
