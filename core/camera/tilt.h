// tilt.h -- a lens that is turned about the centre of its entrance pupil; the film stays across the
// camera's -z.
#pragma once
#include <cmath>

#include "math/transform.h"

namespace dg {

/// Camera from lens, both with +z toward the film and the pupil's centre as origin: turned about the
/// camera's x, then about its y (deg; right-handed: positive x looks up, positive y looks left).
inline Affine3d lens_turn(Vec2d tilt_deg) {
    const double a = tilt_deg.x * kPiD / 180, b = tilt_deg.y * kPiD / 180;
    const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
    return {{cb, 0, -sb}, {sb * sa, ca, cb * sa}, {sb * ca, -sa, cb * ca}, {}};
}

/// How much nearer than the lens's own axis the film is to the pupil along the camera's axis.
inline double tilt_cosine(Vec2d tilt_deg) { return lens_turn(tilt_deg).z.z; }

}  // namespace dg
