// pupil_shape.h -- see pupil_view.h: the region near the entrance pupil of an exact lens where the light of
// a point passes.
#pragma once
#include "camera/pupil_view.h"

namespace dg {

class PupilShape {
  public:
    explicit PupilShape(const ExactLens& lens);

    std::optional<PupilView::Sample> sample(Vec3d p, double w, Vec2f u) const;
    float pdf(Vec3d p, double w, const Ray& ray) const;
};

}  // namespace dg
