// curve_frames.h -- directions across a curve, carried from place to place.
#pragma once
#include "math/vec.h"

namespace dg {

/// `across` after the smallest turn that takes the unit vector `from` to `to`; a unit vector at right
/// angles to `to`.
inline Vec3d transported(Vec3d across, Vec3d from, Vec3d to) {
    const double both = 1 + dot(from, to);
    if (both > 1e-6) across = across - (from + to) * (dot(to, across) / both);
    across = across - to * dot(across, to);  // what rounding left, or an interpolation
    const double size = length(across);
    return size > 1e-6 ? across / size : to_double(Frame::from_normal(to_float(to)).x);
}

}  // namespace dg
