#include "optics/expansion/fit_basis.h"

#include <algorithm>
#include <numeric>

namespace dg {
namespace {

constexpr int kMaxPower = 16;
constexpr int kMaxAxialDispersion = 3;  // highest power of l without `dispersion`

int total(const FitTerm& t) {
    return std::accumulate(t.begin(), t.end(), 0);
}

void sort_by_degree(std::vector<FitTerm>& terms) {
    std::stable_sort(terms.begin(), terms.end(), [](const FitTerm& a, const FitTerm& b) {
        return total(a) < total(b);
    });
}

/// Whether a power has the parity that a mirror symmetry requires.
bool fits(bool mirror, bool odd, int power) {
    return !mirror || (power % 2 == 1) == odd;
}

}  // namespace

std::vector<FitTerm> axial_terms(int degree, int dispersion) {
    const int k = (degree - 1) / 2;
    std::vector<FitTerm> terms;
    for (int s = 0; s <= k; ++s)
        for (int w = 0; w <= k - s; ++w)
            for (int u = 0; u <= k - s - w; ++u) {
                const int rest = k - s - w - u;
                const int most = std::min(rest, kMaxAxialDispersion) +
                                 std::max(dispersion - (k - rest), 0);
                for (int l = 0; l <= most; ++l) terms.push_back({s, w, u, l, 0});
            }
    sort_by_degree(terms);
    return terms;
}

std::vector<FitTerm> free_terms(int degree, const FitSymmetry& symmetry, bool odd_x,
                                bool odd_y, int dispersion) {
    std::vector<FitTerm> terms;
    for (int qx = 0; qx <= degree; ++qx)
        for (int qy = 0; qy <= degree - qx; ++qy)
            for (int fx = 0; fx <= degree - qx - qy; ++fx)
                for (int fy = 0; fy <= degree - qx - qy - fx; ++fy) {
                    if (!fits(symmetry.mirror_x, odd_x, qx + fx)) continue;
                    if (!fits(symmetry.mirror_y, odd_y, qy + fy)) continue;
                    const int spatial = qx + qy + fx + fy;
                    const int most =
                        (degree - spatial) / 2 + std::max(dispersion - spatial / 2, 0);
                    for (int l = 0; l <= most; ++l) terms.push_back({qx, qy, fx, fy, l});
                }
    sort_by_degree(terms);
    return terms;
}

std::vector<FitTerm> light_terms(const FitSymmetry& symmetry) {
    constexpr int kMostPower = 8,
                  kPrice = 3;  // powers of l dropped per 2 ray degrees
    std::vector<FitTerm> terms;
    if (symmetry.axial) {
        for (const FitTerm& t : axial_terms(5))
            if (t[3] == 0)
                for (int l = 0; l <= kMostPower - kPrice * total(t); ++l)
                    terms.push_back({t[0], t[1], t[2], l, 0});
    } else {
        for (const FitTerm& t : free_terms(4, symmetry, false, false))
            if (t[4] == 0)
                for (int l = 0; 2 * l <= 2 * kMostPower - kPrice * total(t); ++l)
                    terms.push_back({t[0], t[1], t[2], t[3], l});
    }
    sort_by_degree(terms);
    return terms;
}

void monomials(const std::vector<FitTerm>& terms, const FitVariables& at,
               double* values) {
    double power[5][kMaxPower];
    for (int v = 0; v < 5; ++v) {
        power[v][0] = 1;
        for (int e = 1; e < kMaxPower; ++e) power[v][e] = power[v][e - 1] * at[v];
    }
    for (const FitTerm& t : terms)
        *values++ = power[0][t[0]] * power[1][t[1]] * power[2][t[2]] * power[3][t[3]] *
                    power[4][t[4]];
}

void FitFunctions::evaluate(const FitVariables& at, double* values) const {
    std::vector<double> term(terms.size());
    monomials(terms, at, term.data());
    std::fill(values, values + count, 0.0);
    for (std::size_t i = terms.size(); i-- > 0;)
        for (int k = 0; k < count; ++k)
            values[k] += term[i] * coefficients[i * count + k];
}

}  // namespace dg
