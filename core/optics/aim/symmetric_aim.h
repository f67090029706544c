// symmetric_aim.h -- the aim of an axially symmetric lens with its film across the axis: see pupil.h. All is
// worked out in the meridional frame, f = (r, 0), for segments of the film radius.
#pragma once
#include "optics/aim/pupil.h"

namespace dg {

Aim make_symmetric_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
