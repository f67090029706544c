// projected_plate.h -- a photograph projected into the scene along the chief rays of its camera.
#pragma once
#include <vector>

#include "render/truth/truth_view.h"
#include "transport/catcher/plate_light.h"

namespace dg {

class ProjectedPlate final : public PlateLight {
  public:
    /// `pixels`: RGB (cd/m2), rows from the top, in the size of the settings' sensor. Uses only sensor and shutter of
    /// the settings. The scene must outlive this.
    ProjectedPlate(const Scene& scene, Camera camera, RenderSettings settings, std::vector<Rgb> pixels);

    std::optional<Rgb> at(Vec3f place, float w, float time) const override;
    Vec3f eye(float time) const override;

  private:
    Rgb pixel(int x, int y) const { return pixels_[std::size_t(y) * settings_.sensor.width + x]; }

    Camera camera_;
    RenderSettings settings_;
    TruthView view_;
    std::vector<Rgb> pixels_;
};

}  // namespace dg
