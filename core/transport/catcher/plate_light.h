// plate_light.h -- a photograph of the set as a light source: objects reflect and refract it, and it lights them. The
// camera of the photograph is known to `render` only.
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
