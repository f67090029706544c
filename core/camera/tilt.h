// tilt.h -- rotation of a lens about the centre of its entrance pupil; the film stays perpendicular
// to the camera's -z.
#pragma once
#include <cmath>

#include "math/transform.h"

namespace dg {

/// Camera from lens, both with +z toward the film and origin at the pupil's centre: rotation about
/// the camera's x, then about its y (deg; right-handed: positive x looks up, positive y looks
/// left).
inline Affine3d lens_turn(Vec2d tilt_deg) {
    const double a = tilt_deg.x * kPiD / 180, b = tilt_deg.y * kPiD / 180;
    const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
    return {{cb, 0, -sb}, {sb * sa, ca, cb * sa}, {sb * ca, -sa, cb * ca}, {}};
}

}  // namespace dg
