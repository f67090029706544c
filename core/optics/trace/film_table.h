// film_table.h -- the transmittance of a coated surface as a polynomial, for the kernels.
//
// T(c, l) = c P(x, l) / (1 + pole c)^2 with c the cosine in the rarer medium, x = 2c - 1 and
// l the wavelength variable (lens_tables.h). T is analytic in c down to grazing; its
// nearest pole is that of the p amplitude of the bare surface, c = -1 / sqrt(1 + n^2), and
// without it P needs half the terms.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace dg {

struct FilmTable {
    float pole = 0;
    std::vector<std::int32_t> terms;  // powers of l for each power of x, highest x first
    std::vector<float> coefficients;  // of those powers, highest l first
};

/// Fits T over cosines [0, 1] and l in [-1, 1] within `tolerance` (absolute). at(l) is T as
/// a function of the cosine. n is the ratio of the indices; phase is half the change of the
/// films' round-trip phase over the range of l.
FilmTable fit_film_table(const std::function<std::function<double(double)>(double)>& at,
                         double n, double phase, double tolerance);

}  // namespace dg
