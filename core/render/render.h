// render.h -- the one page where camera, scene and film meet.
#pragma once
#include <cstdint>
#include <functional>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "film/film.h"
#include "film/filter.h"
#include "render/path.h"
#include "scene/scene.h"

namespace dg {

/// What becomes of the other wavelengths of a path once glass has bent the hero's ray.
enum class Dispersion {
    reproject,       // each at its own film point (dispersion.h)
    end_secondary,   // dropped; the hero alone, at four times its weight: the plain reference
};

struct RenderSettings {
    Sensor sensor;
    std::uint32_t sample_begin = 0, sample_end = 1;
    std::uint64_t seed = 0;
    int threads = 0;                            // 0: all
    double shutter_open_s = 0, shutter_close_s = 0;
    PathSettings path;
    Filter filter;
    Dispersion dispersion = Dispersion::reproject;
};

struct RenderCounters {
    std::uint64_t camera_rays = 0, stopped_rays = 0, rays = 0;
};

/// Draws samples [sample_begin, sample_end) of every pixel of the film's region. `progress` is called
/// from worker threads with the fraction done; returning false stops early (the film is then invalid).
RenderCounters render(const Scene& scene, const Camera& camera, Film& film,
                      const RenderSettings& settings,
                      const std::function<bool(double)>& progress);

}  // namespace dg
