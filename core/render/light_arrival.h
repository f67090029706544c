// light_arrival.h -- light on its way to the lens, along one ray for all of its wavelengths.
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

/// From a point (m, world), past the surface that it lies on and that the ray leaves under this cosine, to where
/// the ray from the lens comes out of what the camera clips. It ends before it starts (t_max < 0) if the point is
/// clipped itself.
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
    Ray shadow;                // world: from where it comes to where rays of the lens start to see
    Spectrum radiance{0.f};    // what a camera path would find there, had it the same density
    std::optional<EmissionPoint> source;   // where it is uneven: radiance waits for the ray's cone on the film
    double density = 0;        // of such light paths; LightWeight
    Wavelengths wavelengths;
    Vec2f u_pixel;
    std::uint32_t sample = 0;  // index of the samples that it belongs to
};

}  // namespace dg
