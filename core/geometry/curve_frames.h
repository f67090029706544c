// curve_frames.h -- parallel transport of directions along a curve.
#pragma once
#include "math/vec.h"

namespace dg {

/// Transports `across` by the smallest rotation from unit vector `from` to `to`; returns a unit
/// vector perpendicular to `to`.
inline Vec3d transported(Vec3d across, Vec3d from, Vec3d to) {
    const double both = 1 + dot(from, to);
    if (both > 1e-6) across = across - (from + to) * (dot(to, across) / both);
    across = across - to * dot(across, to);  // remove errors of rounding or interpolation
    const double size = length(across);
    return size > 1e-6 ? across / size : to_double(Frame::from_normal(to_float(to)).x);
}

}  // namespace dg
