// plate_light.h -- a plate: the photograph behind the picture, as a light source that lights objects and is seen in
// them. `render` implements it with the camera of the photograph.
#pragma once
#include <optional>

#include "geometry/ray.h"
#include "spectrum/spectrum.h"

namespace dg {

class PlateLight {
  public:
    virtual ~PlateLight() = default;
    /// Luminance (cd/m2) in the photograph of a world point (p, 1), m, or a direction (d, 0). Empty outside the
    /// photograph and for pixels that are not finite.
    virtual std::optional<Rgb> at(Vec3f place, float w, float time) const = 0;
    /// Viewpoint of the photograph, m.
    virtual Vec3f eye(float time) const = 0;
};

}  // namespace dg
