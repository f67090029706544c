#include "render/light_guide.h"

#include "render/frame_view.h"

namespace dg {

LightGuide::LightGuide(const Scene& scene, const Camera& camera, const Sensor& sensor,
                       float filter_radius, LightPlan plan)
    : pupil(camera) {
    const bool sky_turns = scene.description().environment_keys.has_value();
    const std::vector<ViewCone> views = frame_views(camera, sensor, filter_radius + 1, sky_turns);
    lens_radius = views.front().from.radius;
    if (plan.m1 > 0) emission = EmissionSampler(scene.lights(), views, plan.sky);
    if (plan.m2 > 0) rays = EmissionRays(scene.lights(), scene.emission_reach());
}

}  // namespace dg
