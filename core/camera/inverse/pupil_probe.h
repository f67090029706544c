// pupil_probe.h -- camera rays that show where light passes an exact lens.
#pragma once
#include <vector>

#include "camera/exact.h"

namespace dg {

/// Rays that the camera draws, at all wavelengths and film points: those at the
/// rim of what passes, and some within. `axial`: the lens is the same on all sides.
std::vector<CameraRay> probe_pupil(const ExactLens& lens, bool axial);

}  // namespace dg
