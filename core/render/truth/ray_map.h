// ray_map.h -- the chief ray of each pixel's centre, at the moment of its line.
#pragma once
#include <vector>

#include "camera/camera.h"
#include "camera/inverse/chief.h"
#include "camera/sensor.h"
#include "camera/shutter.h"
#include "film/film.h"

namespace dg {

/// Rows from the top; NaN where no light comes to a pixel.
struct PixelRays {
    std::vector<Vec3d> origins, directions;  // m, unit
    std::vector<double> times;               // fraction of the scene's interval; known for all
};

/// Whether light comes to a film point (mm, upright). `chief`: those of the lens at that time.
bool sees(const Camera& camera, const ChiefRays& chief, Vec2d film_mm, float time);

/// Which frame rays are in: the camera's own at each ray's time, or the world's.
enum class RayFrame { camera, world };

/// Rays of the pixels of a region, which may lie beside the frame. Of the layout its place and size count.
PixelRays ray_map(const Camera& camera, const Sensor& sensor, const Shutter& shutter,
                  const FilmLayout& region, RayFrame frame, int threads);

}  // namespace dg
