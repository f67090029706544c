// plate_light.h -- the light of a photograph of the set: what objects see of it in mirrors and through glass, and what
// it sends to them. Which camera took it only `render` knows.
#pragma once
#include <optional>

#include "geometry/ray.h"
#include "spectrum/spectrum.h"

namespace dg {

class PlateLight {
  public:
    virtual ~PlateLight() = default;
    /// Luminance (cd/m2) that the photograph shows at a place of the world: (p, 1) a point in m, (d, 0) a direction.
    /// Nothing where the place is outside of it, or has no number.
    virtual std::optional<Rgb> at(Vec3f place, float w, float time) const = 0;
    /// From where it was taken, m.
    virtual Vec3f eye(float time) const = 0;
};

}  // namespace dg
