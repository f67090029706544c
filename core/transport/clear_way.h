// clear_way.h -- the surfaces that a camera sees through along a ray, for autofocus behind windows and ports.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace dg {

/// A surface along a ray.
struct WayPoint {
    Vec3f position;                // m
    std::uint32_t instance;        // Interior::kWorld: a sphere light
    std::optional<Vec3f> onward;   // direction behind a clear surface; empty: the ray ends here
};

/// Surfaces that a ray meets at mid-interval. It is refracted by clear smooth surfaces, in yellow light, and ends at the
/// first other surface. Passes media and hidden boundaries.
std::vector<WayPoint> clear_way(const Scene& scene, Ray ray);

}  // namespace dg
