// decompose.h -- a linear map as rotation after stretch.
#pragma once
#include <optional>

#include "math/quaternion.h"
#include "math/transform.h"

namespace dg {

/// M = R S; origins are 0.
struct RotationStretch {
    Quaterniond rotation;
    Affine3d stretch;
};

/// Polar decomposition: the closest rotation, and a symmetric stretch, which a mirror makes negative.
/// Empty where the map has no inverse. Source: Higham 1986, Computing the Polar Decomposition, SIAM J.
/// Sci. Stat. Comput. 7(4); Shoemake and Duff 1992 for the factor -1 of mirrors.
std::optional<RotationStretch> polar(const Affine3d& m);

/// Rotation after scales along the axes (the first of them negative for a mirror). Empty where the
/// columns are not at right angles, or one is 0.
std::optional<RotationStretch> scaled_rotation(const Affine3d& m);

/// Most that the map makes any vector longer.
double spectral_norm(const Affine3d& m);

}  // namespace dg
