// free_aim.h -- aim (pupil.h) of a lens without axial symmetry, or with a tilted film. Cells of the
// film take the place of radial segments.
#pragma once
#include "optics/aim/pupil.h"

namespace dg {

Aim make_free_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
