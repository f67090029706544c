// free_basis.h -- film slope of a lens without axial symmetry (anamorphic, decentred, or with a
// tilted film): m(f, a, l) in the complete polynomial basis of film coordinates f, iris coordinates
// a and wavelength variable l, all within [-1, 1]. A power of l counts twice in the degree, as in
// symmetric_basis.h.
#pragma once
#include <vector>

#include "optics/aim/symmetric_basis.h"

namespace dg {

/// Calls visit(i, j, p, q, r) with the powers of a.x, a.y, f.x, f.y and l, in the storage order of
/// the coefficients: Horner's rule, with a.x outermost.
template <typename Visit>
void for_each_free_term(int degree, Visit visit) {
    for (int i = degree; i >= 0; --i)
        for (int j = degree - i; j >= 0; --j)
            for (int p = degree - i - j; p >= 0; --p)
                for (int q = degree - i - j - p; q >= 0; --q)
                    for (int r = (degree - i - j - p - q) / 2; r >= 0; --r) visit(i, j, p, q, r);
}

int free_term_count(int degree);

struct FreeSlopeSample {
    Vec2d f, a;
    double l;
    Vec2d m;
};

/// Polynomials for m.x and m.y; coefficients are interleaved.
struct FreePolynomial {
    int degree = 3;
    std::vector<double> coefficients;

    SlopeValue evaluate(Vec2d f, Vec2d a, double l) const;
};

/// Least-squares fit to traced rays by Householder QR.
FreePolynomial fit_free_slopes(const std::vector<FreeSlopeSample>& samples, int degree);

}  // namespace dg
