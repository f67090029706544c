// fit_bend.h -- the bend of a fit: q + f A + q B with low polynomials A and B, a
// nonlinear coordinate of the film ray in which what is left to the complete basis is
// smaller.
//
// Its coefficients are those under which the direction's least squares leave least
// (variable projection: Golub and Pereyra 1973, The Differentiation of Pseudo-Inverses
// and Nonlinear Least Squares Problems Whose Variables Separate, SIAM J. Numer. Anal.
// 10(2); here with the derivative of Kaufman 1975, BIT 15, and Marquardt's damping). No
// iris or other surface takes part: the result is a coordinate, not a point on something.
#pragma once
#include "optics/expansion/lens_fit_make.h"

namespace dg {

/// For a segment, whose range is read. Nothing if the degree or what is left of the
/// lens's symmetry is too low to pay: below 5, or without both mirrors. Nor in wide
/// fields.
FitBlock find_bend(const LensFit& fit, const FitSegment& segment,
                   const std::vector<FitSample>& clear);

}  // namespace dg
