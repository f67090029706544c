// render.h -- the one page where camera, scene and film meet.
#pragma once
#include <cstdint>
#include <functional>

#include "camera/camera.h"
#include "film/film.h"
#include "film/filter.h"
#include "render/path.h"
#include "scene/scene.h"

namespace dg {

struct RenderSettings {
    int width = 0, height = 0;                  // full frame, px
    double sensor_width_mm = 36, sensor_height_mm = 24;   // the part that the frame covers
    Vec2d sensor_center_mm{0, 0};               // film shift
    std::uint32_t sample_begin = 0, sample_end = 1;
    std::uint64_t seed = 0;
    int threads = 0;                            // 0: all
    double shutter_open_s = 0, shutter_close_s = 0;
    PathSettings path;
    Filter filter;
};

struct RenderCounters {
    std::uint64_t camera_rays = 0, stopped_rays = 0, rays = 0;
};

/// Draws samples [sample_begin, sample_end) of every pixel of the film's region. `progress` is called
/// from worker threads with the fraction done; returning false stops early (the film is then invalid).
RenderCounters render(const Scene& scene, const Camera& camera, Film& film,
                      const RenderSettings& settings, const std::function<bool(double)>& progress);

}  // namespace dg
