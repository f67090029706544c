// light_arrival.h -- light on its way to the lens, along one ray for all of its wavelengths.
#pragma once
#include <cstdint>
#include <optional>

#include "camera/camera_sample.h"
#include "geometry/ray.h"
#include "light/emission.h"
#include "spectrum/wavelengths.h"

namespace dg {

struct LightArrival {
    CameraRay lens;            // camera frame
    Ray shadow;                // world: from where it comes to where rays of the lens start
    Spectrum radiance{0.f};    // what a camera path would find there, had it the same density
    std::optional<EmissionPoint> source;   // where it is uneven: radiance waits for the ray's cone on the film
    double density = 0;        // of such light paths; LightWeight
    Wavelengths wavelengths;
    Vec2f u_pixel;
    std::uint32_t sample = 0;  // index of the samples that it belongs to
};

}  // namespace dg
