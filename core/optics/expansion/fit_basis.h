// fit_basis.h -- monomials of a fitted lens, and functions over them.
//
// Axially symmetric lenses: vectors f A(s, W, U, l) + q B(s, W, U, l) and scalars C(s, W, U, l),
// where f is the film point, q the pupil point of the film ray (lens_fit.h), s = f.q, W = 2|q|^2 -
// 1, U = |f|^2 mapped from the segment's range to [-1, 1], and l the wavelength variable. Ray
// degree 2k + 1 has all powers of total degree up to k, with powers of l up to 3 (symmetry: Hullin,
// Hanika and Heidrich 2012, CGF 31(4)). Other lenses: all monomials of the four coordinates, where
// a power of l counts twice. `dispersion` adds powers of l, mostly to terms of low degree in the
// other variables.
#pragma once
#include <array>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Powers of (s, W, U, l, 1), or of (q.x, q.y, f.x, f.y, l) without axial symmetry.
using FitTerm = std::array<int, 5>;
using FitVariables = std::array<double, 5>;

/// Highest `dispersion` that a fit tries: infrared absorption makes the index of real glass a
/// slowly convergent series in 1 / wavelength^2.
inline constexpr int kMostDispersion = 3;

/// Symmetry of a lens.
struct FitSymmetry {
    bool axial = true, mirror_x = true, mirror_y = true;  // mirror planes x -> -x, y -> -y
};

/// Complete basis of a ray degree, sorted by total degree from the constant up, so that the basis
/// of a lower degree is its prefix. `dispersion`: additional powers of l for the constant; one less
/// per 2 ray degrees in the other variables.
std::vector<FitTerm> axial_terms(int degree, int dispersion = 0);
/// Complete basis for lenses without axial symmetry. `odd_x`: for functions that change sign with x
/// (the x component of a vector); a mirror plane restricts terms to odd or even powers.
std::vector<FitTerm> free_terms(int degree, const FitSymmetry& symmetry, bool odd_x,
                                bool odd_y, int dispersion = 0);

/// Basis of the transmittance, which varies slowly over film and pupil, but oscillates with
/// wavelength (coatings): powers of l up to 8, and up to ray degree 4 in the other variables.
std::vector<FitTerm> light_terms(const FitSymmetry& symmetry);

/// Evaluates all terms.
void monomials(const std::vector<FitTerm>& terms, const FitVariables& at, double* values);

/// Polynomials over a common set of terms.
struct FitFunctions {
    int count = 0;
    std::vector<FitTerm> terms;
    std::vector<double> coefficients;  // [term][function]

    /// Writes (does not accumulate) `count` values.
    void evaluate(const FitVariables& at, double* values) const;
};

}  // namespace dg
