#include "render/light_weight.h"

namespace dg {
namespace {

std::shared_ptr<const LightGuide> guide_of(const Scene& scene, const Camera& camera, const Sensor& sensor,
                                           const FilmDensity& density, LightPlan plan,
                                           std::shared_ptr<const LightGuide> earlier) {
    if (plan.off() || earlier) return earlier;
    return std::make_shared<const LightGuide>(scene, camera, sensor, density.filter().radius(), plan);
}

}  // namespace

LightWeight::LightWeight(const Scene& scene, const Camera& camera, const Sensor& sensor,
                         const FilmDensity& density, LightPlan plan, Technique technique,
                         std::shared_ptr<const LightGuide> guide)
    : LightWeight(camera, plan, technique, density.integral_of_any_time(),
                  guide_of(scene, camera, sensor, density, plan, std::move(guide))) {}

LightWeight::LightWeight(const Camera& camera, LightPlan plan, Technique technique, double scale,
                         std::shared_ptr<const LightGuide> guide)
    : LightSharing(plan, technique, scale, guide ? &guide->emission : nullptr, guide ? &guide->rays : nullptr),
      camera_(camera),
      guide_(std::move(guide)) {}

Viewpoint LightWeight::viewpoint(float time) const {
    return {to_float(camera_.world_from_camera.at(time).origin), guide_->lens_radius};
}

}  // namespace dg
