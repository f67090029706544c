// pupil_probe.h -- camera rays that bound the pupil of an exact lens.
#pragma once
#include <vector>

#include "camera/exact.h"

namespace dg {

/// Passing camera rays at all wavelengths and film points: rays at the rim of the pupil, and some
/// inside. `axial`: the lens is axially symmetric.
std::vector<CameraRay> probe_pupil(const ExactLens& lens, bool axial);

}  // namespace dg
