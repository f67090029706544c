// fit_vectors.h -- least-squares fits of vectors and scalars of samples.
#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

#include "optics/expansion/fit_equations.h"
#include "optics/expansion/fit_rays.h"

namespace dg {

struct FitBasis {
    int degree = 1, dispersion = 0;
    int keep = 0;       // number of terms per vector; 0: all
    double enough = 0;  // root mean square error; positive: stop adding terms when it is reached
};

/// Coordinates of a sample in the fit.
struct FitPlace {
    FitVariables variables;
    Vec2d f, q;
};

/// Dense or sparse solution, as the basis asks.
std::vector<double> solve(const FitEquations& e, const FitBasis& few,
                          std::size_t samples);

/// Drops terms with only zero coefficients.
FitFunctions packed(const FitFunctions& f);
/// Subset of the functions.
FitFunctions functions_of(const FitFunctions& f, int first, int count);
/// Subset of the vectors.
FitBlock vectors_of(const FitBlock& b, int first, int count, bool axial);
/// Concatenates functions; the terms become the union.
FitFunctions side_by_side(const FitFunctions& a, const FitFunctions& b);
FitBlock side_by_side(const FitBlock& a, const FitBlock& b);

/// Fits vectors f A + q B: two equations per sample; coefficients of A and B alternate.
template <typename Place, typename Vectors>
FitFunctions fit_axial(const std::vector<FitTerm>& terms,
                       const std::vector<FitSample>& samples, int vectors,
                       const FitBasis& few, Place place, Vectors outputs) {
    const int n = int(terms.size());
    FitEquations e{2 * n, vectors};
    e.matrix.reserve(samples.size() * 4 * n), e.rhs.reserve(samples.size() * 2 * vectors);
    std::vector<double> value(n);
    for (const FitSample& s : samples) {
        const FitPlace at = place(s);
        monomials(terms, at.variables, value.data());
        for (int k = 0; k < 2; ++k) {
            for (int t = 0; t < n; ++t) {
                e.matrix.push_back((k ? at.f.y : at.f.x) * value[t]);
                e.matrix.push_back((k ? at.q.y : at.q.x) * value[t]);
            }
            for (int v = 0; v < vectors; ++v)
                e.rhs.push_back(k ? outputs(s, v).y : outputs(s, v).x);
        }
    }
    const std::vector<double> x = solve(e, few, samples.size());
    FitFunctions found{2 * vectors, terms, {}};
    for (int t = 0; t < n; ++t)
        for (int v = 0; v < vectors; ++v)
            for (int side = 0; side < 2; ++side)
                found.coefficients.push_back(x[(2 * t + side) * vectors + v]);
    return packed(found);
}

/// Fits scalars: one equation per sample.
template <typename Place, typename Numbers>
FitFunctions fit_scalars(const std::vector<FitTerm>& terms,
                         const std::vector<FitSample>& samples, int count,
                         const FitBasis& few, Place place, Numbers outputs) {
    const int n = int(terms.size());
    FitEquations e{n, count};
    e.matrix.reserve(samples.size() * n), e.rhs.reserve(samples.size() * count);
    std::vector<double> value(n);
    for (const FitSample& s : samples) {
        monomials(terms, place(s).variables, value.data());
        e.matrix.insert(e.matrix.end(), value.begin(), value.end());
        for (int v = 0; v < count; ++v) e.rhs.push_back(outputs(s, v));
    }
    return packed({count, terms, solve(e, few, samples.size())});
}

template <typename Place, typename Vectors>
FitBlock fit_vectors(const FitSymmetry& symmetry, const FitBasis& basis,
                     const std::vector<FitSample>& samples, int count, Place place,
                     Vectors outputs) {
    const int more = basis.dispersion;
    if (symmetry.axial)
        return {fit_axial(axial_terms(basis.degree, more), samples, count, basis, place,
                          outputs),
                {}};
    return {fit_scalars(free_terms(basis.degree, symmetry, true, false, more), samples,
                        count, basis, place,
                        [&](const FitSample& s, int v) { return outputs(s, v).x; }),
            fit_scalars(free_terms(basis.degree, symmetry, false, true, more), samples,
                        count, basis, place,
                        [&](const FitSample& s, int v) { return outputs(s, v).y; })};
}

}  // namespace dg
