// symmetric_aim.h -- aim (pupil.h) of an axially symmetric lens with its film perpendicular to the
// axis. Computed in the meridional frame, f = (r, 0), for radial segments of the film.
#pragma once
#include "optics/aim/pupil.h"

namespace dg {

Aim make_symmetric_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
