// symmetric_basis.h -- the complete basis with the lens's symmetry. With f the film point and
// a the iris point, every axially symmetric map has the form m = f A(u, s, w, l) + a B(u,
// s, w, l), where u = |f|^2, s = f.a, w = |a|^2 and l stands for the wavelength
// (symmetry: Hullin, Hanika and Heidrich 2012, Polynomial Optics, CGF 31(4)).
//
// f and a are given in units that make them at most 1, in the meridional frame: f = (r,
// 0). The basis is all monomials U^p s^i W^j l^q, U = 2u-1, W = 2w-1, with p + i + j + 2q
// <= k: dispersion is a small correction, so that a power of l costs two.
#pragma once
#include <vector>

#include "math/vec.h"

namespace dg {

/// Calls visit(i, j, p, q) in the order in which the coefficients are stored: highest
/// powers first, the order of Horner's rule (s outside, then W, then U, then l).
template <typename Visit>
void for_each_term(int k, Visit visit) {
    for (int i = k; i >= 0; --i)
        for (int j = k - i; j >= 0; --j)
            for (int p = k - i - j; p >= 0; --p)
                for (int q = (k - i - j - p) / 2; q >= 0; --q) visit(i, j, p, q);
}

int term_count(int k);

struct SlopeValue {
    Vec2d m;                    // (tangential, sagittal)
    double jacobian;            // det dm/da, signed
    double m11, m12, m21, m22;  // dm/da

    /// To first order, by how much a must change for m to change by e.
    Vec2d step(Vec2d e) const {
        return {(m22 * e.x - m12 * e.y) / jacobian, (m11 * e.y - m21 * e.x) / jacobian};
    }
};

/// A and B, coefficients in turn.
struct SlopePolynomial {
    int k = 3;
    std::vector<double> coefficients;

    SlopeValue evaluate(double r, Vec2d a, double l) const;
};

struct SlopeSample {
    double r;  // film radius
    Vec2d a;   // iris point
    double l;  // wavelength variable
    Vec2d m;   // film slope
};

/// Least squares fit to traced rays by Householder QR.
SlopePolynomial fit_slopes(const std::vector<SlopeSample>& samples, int k);

}  // namespace dg
