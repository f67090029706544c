// ray.h -- world-space ray (m) at an instant.
#pragma once
#include <cmath>
#include <limits>

#include "geometry/ray_cone.h"
#include "math/vec.h"

namespace dg {

struct Ray {
    Vec3f origin;     // m
    Vec3f direction;  // unit
    float time = 0;   // fraction of the scene's interval; secondary rays inherit it
    float t_min = 0;  // m
    float t_max = std::numeric_limits<float>::infinity();
    RayCone cone = {};  // empty: textures are point-sampled
    bool without_objects = false;  // hits only catchers (scene/catcher.h)
};

/// Whether a ray tracer accepts the ray: no NaN or infinity, and no overflow in its arithmetic.
inline bool is_traceable(Vec3f origin, Vec3f direction) {
    return std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z) + std::abs(direction.x) +
               std::abs(direction.y) + std::abs(direction.z) <
           kFar;
}
inline bool is_traceable(const Ray& ray) { return is_traceable(ray.origin, ray.direction); }

}  // namespace dg
