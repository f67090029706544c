// light_weight.h -- MIS between camera paths and light paths (transport/sharing/light_sharing.h), with the densities of
// the lens.
#pragma once
#include <memory>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "render/dispersion.h"
#include "render/light_guide.h"
#include "scene/scene.h"
#include "transport/sharing/light_sharing.h"

namespace dg {

class LightWeight : public LightSharing {
  public:
    /// `plan`: paths per unit of the density's counts. `guide`: from an earlier pass of this picture, or null. The
    /// remaining arguments must outlive this.
    LightWeight(const Scene& scene, const Camera& camera, const Sensor& sensor,
                const FilmDensity& density, LightPlan plan, Technique technique,
                std::shared_ptr<const LightGuide> guide);

    const PupilViewOverTime& pupil() const { return guide_->pupil; }
    Viewpoint viewpoint(float time) const;
    Affine3d pose(float time) const { return camera_.world_from_camera.at(time); }

  private:
    LightWeight(const Camera& camera, LightPlan plan, Technique technique, double scale,
                std::shared_ptr<const LightGuide> guide);

    const Camera& camera_;
    std::shared_ptr<const LightGuide> guide_;   // null if no light paths are drawn
};

}  // namespace dg
