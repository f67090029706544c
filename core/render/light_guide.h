// light_guide.h -- samplers for light paths, built once per picture.
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
    EmissionSampler emission;    // for paths directly to the lens
    EmissionRays rays;           // for paths with bounces
    PupilViewOverTime pupil;
    float lens_radius = 0;       // m: radius around the camera's origin that contains all rays through the lens

    /// Builds the samplers that `plan` needs. `filter_radius`: px. The scene must outlive the guide.
    LightGuide(const Scene& scene, const Camera& camera, const Sensor& sensor, float filter_radius,
               LightPlan plan);
};

}  // namespace dg
