// light_arrival.h -- a light path's connection to the lens, along one ray for all wavelengths.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "camera/camera_sample.h"
#include "geometry/ray.h"
#include "light/emission.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// Shadow ray from a point on a surface (m, world) to the near clip of the camera, along a ray from the lens. `cosine`
/// is the angle at the surface, for the offset from it. t_max < 0 if the point itself is clipped.
inline Ray shadow_ray(Vec3f at, float cosine, const Ray& from_lens) {
    const Vec3f b = from_lens.origin;
    const float largest = std::max(largest_coordinate(at), largest_coordinate(b));
    return {.origin = at,
            .direction = -from_lens.direction,
            .time = from_lens.time,
            .t_min = 0x1p-19f * largest / cosine,
            .t_max = length(b - at) - from_lens.t_min};
}

struct LightArrival {
    CameraRay lens;            // camera frame
    Ray shadow;                // world: from the vertex to the camera's near clip
    Spectrum radiance{0.f};    // radiance estimate of a camera path with the same density
    std::optional<EmissionPoint> source;   // textured emitter: its radiance is looked up once the ray cone is known
    double density = 0;        // of light paths, in the measure of LightWeight
    Wavelengths wavelengths;
    Vec2f u_pixel;
    std::uint32_t sample = 0;  // sample index that the light path belongs to
};

}  // namespace dg
