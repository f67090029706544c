// fit_bend.h -- bend of a fit: q + f A + q B with polynomials A and B of low degree. It is a
// nonlinear coordinate of the film ray in which the complete basis has a smaller residual.
//
// The coefficients minimize the least-squares residual of the direction (variable projection: Golub
// and Pereyra 1973, The Differentiation of Pseudo-Inverses and Nonlinear Least Squares Problems
// Whose Variables Separate, SIAM J. Numer. Anal. 10(2); here with the derivative of Kaufman 1975,
// BIT 15, and Marquardt's damping). The bent q is only a coordinate; it is not a point on the iris
// or on another surface.
#pragma once
#include "optics/expansion/lens_fit_make.h"

namespace dg {

/// Finds the bend for the range of a segment. Empty where a bend does not pay: degrees below 5,
/// lenses without both mirror symmetries, and wide fields.
FitBlock find_bend(const LensFit& fit, const FitSegment& segment,
                   const std::vector<FitSample>& clear);

}  // namespace dg
