// fit_basis.h -- the monomials of a fitted lens, and functions over them.
//
// Axially symmetric lenses: vectors f A(s, W, U, l) + q B(s, W, U, l), scalars C(s, W, U,
// l), f the film point, q the second point of the film ray (see lens_fit.h), s = f.q, W =
// 2|q|^2 - 1, U = |f|^2 over the segment's range mapped to [-1, 1], l the wavelength
// variable. A ray degree of 2k + 1 is all powers of total degree up to k, those of l up
// to 3 (symmetry: Hullin, Hanika and Heidrich 2012, CGF 31(4)). Lenses without that
// symmetry: all monomials of the four coordinates, a power of l costs two. Dispersion
// adds powers of l, most of them to the lowest degrees of the other variables.
#pragma once
#include <array>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Powers of (s, W, U, l, 1), or of (q.x, q.y, f.x, f.y, l) without symmetry.
using FitTerm = std::array<int, 5>;
using FitVariables = std::array<double, 5>;

/// Dispersion that a fit tries: the infrared terms of real glass make its index a slow
/// series in 1 / wavelength^2.
inline constexpr int kMostDispersion = 3;

/// Symmetry that is left of a lens: planes that may be mirrors.
struct FitSymmetry {
    bool axial = true, mirror_x = true, mirror_y = true;  // x -> -x, y -> -y
};

/// Complete basis of a ray degree; constants first, in order of total degree, so that a
/// lower degree is the head of a higher one. `dispersion`: further powers of l of a
/// constant; each ray degree of 2 in the other variables has one less.
std::vector<FitTerm> axial_terms(int degree, int dispersion = 0);
/// The same for a lens of full ray degree without axial symmetry. `odd_x`: of a function
/// that changes its sign with x (the x of a vector); mirrors leave odd or even powers
/// only.
std::vector<FitTerm> free_terms(int degree, const FitSymmetry& symmetry, bool odd_x,
                                bool odd_y, int dispersion = 0);

/// For the transmittance: it varies little over film and pupil, and in waves with the
/// wavelength (coatings). Powers of l up to 8, of the other variables up to a ray degree
/// of 4.
std::vector<FitTerm> light_terms(const FitSymmetry& symmetry);

/// Value of every term.
void monomials(const std::vector<FitTerm>& terms, const FitVariables& at, double* values);

/// Some functions over the same terms.
struct FitFunctions {
    int count = 0;
    std::vector<FitTerm> terms;
    std::vector<double> coefficients;  // [term][function]

    /// Adds nothing, writes `count` values.
    void evaluate(const FitVariables& at, double* values) const;
};

}  // namespace dg
