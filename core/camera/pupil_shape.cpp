#include "camera/pupil_shape.h"

namespace dg {

PupilShape::PupilShape(const ExactLens&) {}
std::optional<PupilView::Sample> PupilShape::sample(Vec3d, double, Vec2f) const { return std::nullopt; }
float PupilShape::pdf(Vec3d, double, const Ray&) const { return 0; }

}  // namespace dg
