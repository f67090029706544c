// free_aim.h -- the aim of a lens without axial symmetry, or of a tilted film: see pupil.h. The film is
// divided into cells in place of radii.
#pragma once
#include "optics/aim/pupil.h"

namespace dg {

Aim make_free_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
