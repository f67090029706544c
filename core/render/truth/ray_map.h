// ray_map.h -- the chief ray of each pixel center, at the time of the pixel's line.
#pragma once
#include <vector>

#include "camera/camera.h"
#include "camera/inverse/chief.h"
#include "camera/sensor.h"
#include "camera/shutter.h"
#include "film/film.h"

namespace dg {

/// Rays, row by row from the top; NaN where no light reaches a pixel.
struct PixelRays {
    std::vector<Vec3d> origins, directions;  // m, unit
    std::vector<double> times;               // fraction of the scene's interval; never NaN
};

/// Whether light reaches a film point (mm, upright). `chief`: chief rays of the lens at that time.
bool sees(const Camera& camera, const ChiefRays& chief, Vec2d film_mm, float time);

/// Coordinate frame of rays: the camera at each ray's time, or the world.
enum class RayFrame { camera, world };

/// Rays of the pixels of a region, which may extend beyond the frame. Uses only position and size of the layout.
PixelRays ray_map(const Camera& camera, const Sensor& sensor, const Shutter& shutter,
                  const FilmLayout& region, RayFrame frame, int threads);

}  // namespace dg
