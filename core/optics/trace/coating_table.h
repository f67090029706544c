// coating_table.h -- the transmittance of a coated surface as a polynomial, for the kernels.
//
// T(c, l) = c P(x, l) / (1 + pole c)^2, where c is the cosine in the rarer medium, x = 2c - 1 and l
// is the wavelength variable (lens_tables.h). T is analytic in c down to grazing incidence. Its
// nearest pole is the pole of the bare surface's p amplitude, c = -1 / sqrt(1 + n^2); dividing it
// out halves the number of terms of P.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace dg {

struct CoatingTable {
    float pole = 0;
    std::vector<std::int32_t> terms;  // number of powers of l for each power of x, highest x first
    std::vector<float> coefficients;  // coefficients of these powers, highest l first
};

/// Fits T over cosines in [0, 1] and l in [-1, 1] within the absolute tolerance. at(l) returns T as
/// a function of the cosine; n is the ratio of the indices; phase is half the change of the films'
/// round-trip phase over the range of l.
CoatingTable fit_coating_table(const std::function<std::function<double(double)>(double)>& at,
                         double n, double phase, double tolerance);

}  // namespace dg
