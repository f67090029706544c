// decompose.h -- decompositions of a linear map into rotation and stretch.
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

/// Polar decomposition into the closest rotation and a symmetric stretch, negated for mirroring
/// maps. Empty for a singular map. Source: Higham 1986, Computing the Polar Decomposition, SIAM J.
/// Sci. Stat. Comput. 7(4); Shoemake and Duff 1992 for the factor -1 of mirrors.
std::optional<RotationStretch> polar(const Affine3d& m);

/// Decomposition into a rotation and scales along the axes (the first scale is negative for
/// mirrors). Empty if the columns are not orthogonal, or one is 0.
std::optional<RotationStretch> scaled_rotation(const Affine3d& m);

/// Spectral norm: largest factor by which the map lengthens a vector.
double spectral_norm(const Affine3d& m);

}  // namespace dg
