// symmetric_basis.h -- complete polynomial basis with axial symmetry. With film point f and iris
// point a, every axially symmetric map has the form m = f A(u, s, w, l) + a B(u, s, w, l), where u
// = |f|^2, s = f.a, w = |a|^2 and l is the wavelength variable (symmetry: Hullin, Hanika and
// Heidrich 2012, Polynomial Optics, CGF 31(4)).
//
// f and a are scaled to at most 1 and given in the meridional frame: f = (r, 0). The basis consists
// of the monomials U^p s^i W^j l^q, U = 2u-1, W = 2w-1, with p + i + j + 2q <= k. A power of l
// counts twice, because dispersion is a small correction.
#pragma once
#include <vector>

#include "math/vec.h"

namespace dg {

/// Calls visit(i, j, p, q) in the storage order of the coefficients: highest powers first, as in
/// Horner's rule (s outermost, then W, then U, then l).
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

    /// First-order change of a that changes m by e.
    Vec2d step(Vec2d e) const {
        return {(m22 * e.x - m12 * e.y) / jacobian, (m11 * e.y - m21 * e.x) / jacobian};
    }
};

/// Polynomials A and B; coefficients are interleaved.
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

/// Least-squares fit to traced rays by Householder QR.
SlopePolynomial fit_slopes(const std::vector<SlopeSample>& samples, int k);

}  // namespace dg
