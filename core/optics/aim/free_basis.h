// free_basis.h -- the film slope of a lens without axial symmetry (anamorphic, decentred, or with a
// tilted film): m(f, a, l) in the complete basis of the two film coordinates f, the two iris coordinates a
// and the wavelength variable l, all at most 1. A power of l costs two, as in symmetric_basis.h.
#pragma once
#include <vector>

#include "optics/aim/symmetric_basis.h"

namespace dg {

/// Calls visit(i, j, p, q, r), the powers of a.x, a.y, f.x, f.y and l, in the order in which the
/// coefficients are stored: that of Horner's rule, a.x outside.
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

/// The coefficients of m.x and m.y in turn.
struct FreePolynomial {
    int degree = 3;
    std::vector<double> coefficients;

    SlopeValue evaluate(Vec2d f, Vec2d a, double l) const;
};

/// Least squares fit to traced rays by Householder QR.
FreePolynomial fit_free_slopes(const std::vector<FreeSlopeSample>& samples, int degree);

}  // namespace dg
