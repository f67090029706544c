#include "optics/expansion/fit_vectors.h"

#include <cmath>

namespace dg {

std::vector<double> solve(const FitEquations& e, const FitBasis& few,
                          std::size_t samples) {
    if (few.keep == 0 && few.enough > 0)
        return e.solve_sparse(e.columns, few.enough * std::sqrt(double(samples)));
    return few.keep > 0 ? e.solve_sparse(few.keep) : e.solve();
}

FitFunctions packed(const FitFunctions& f) {
    FitFunctions used{f.count, {}, {}};
    for (std::size_t t = 0; t < f.terms.size(); ++t) {
        const auto first = f.coefficients.begin() + std::ptrdiff_t(t) * f.count;
        if (std::all_of(first, first + f.count, [](double c) { return c == 0; }))
            continue;
        used.terms.push_back(f.terms[t]);
        used.coefficients.insert(used.coefficients.end(), first, first + f.count);
    }
    return used.terms.empty() ? f : used;
}

FitFunctions functions_of(const FitFunctions& f, int first, int count) {
    FitFunctions some{count, f.terms, {}};
    for (std::size_t t = 0; t < f.terms.size(); ++t) {
        const auto row = f.coefficients.begin() + std::ptrdiff_t(t) * f.count + first;
        some.coefficients.insert(some.coefficients.end(), row, row + count);
    }
    return packed(some);
}

FitBlock vectors_of(const FitBlock& b, int first, int count, bool axial) {
    if (axial) return {functions_of(b.x, 2 * first, 2 * count), {}};
    return {functions_of(b.x, first, count), functions_of(b.y, first, count)};
}

FitFunctions side_by_side(const FitFunctions& a, const FitFunctions& b) {
    if (a.count == 0) return b;
    const int count = a.count + b.count;
    std::map<FitTerm, std::size_t> row;
    FitFunctions all{count, {}, {}};
    int first = 0;
    for (const FitFunctions* f : {&a, &b}) {
        for (std::size_t t = 0; t < f->terms.size(); ++t) {
            const auto [at, fresh] = row.try_emplace(f->terms[t], all.terms.size());
            if (fresh) {
                all.terms.push_back(f->terms[t]);
                all.coefficients.resize(all.coefficients.size() + count);
            }
            for (int k = 0; k < f->count; ++k)
                all.coefficients[at->second * count + first + k] =
                    f->coefficients[t * f->count + k];
        }
        first += f->count;
    }
    return all;
}

FitBlock side_by_side(const FitBlock& a, const FitBlock& b) {
    return {side_by_side(a.x, b.x), side_by_side(a.y, b.y)};
}

}  // namespace dg
