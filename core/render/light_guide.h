// light_guide.h -- what light paths are drawn with: found once for a picture, however many passes it takes.
#pragma once
#include <memory>

#include "camera/inverse/pupil_view.h"
#include "camera/sensor.h"
#include "light/emission.h"
#include "light/emission_ray.h"
#include "scene/scene.h"
#include "transport/sharing/light_plan.h"

namespace dg {

struct LightGuide {
    EmissionSampler emission;    // of paths straight to the lens
    EmissionRays rays;           // of those with bounces
    PupilViewOverTime pupil;
    float lens_radius = 0;       // m: all rays of the lens pass within it of the camera's origin

    /// For the kinds of paths that the plan has; the reach of the pixels' filter in px. The scene outlives it.
    LightGuide(const Scene& scene, const Camera& camera, const Sensor& sensor, float filter_radius,
               LightPlan plan);
};

}  // namespace dg
