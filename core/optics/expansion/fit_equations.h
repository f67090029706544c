// fit_equations.h -- linear least-squares problems of a fit, dense or sparse.
#pragma once
#include <vector>

namespace dg {

/// Rows of a matrix and of one or more right-hand sides.
struct FitEquations {
    int columns = 0, sides = 0;
    std::vector<double> matrix{}, rhs{};

    int rows() const { return int(rhs.size()) / sides; }
    /// Dense solution, [column][side].
    std::vector<double> solve() const;
    /// Sparse solution with at most `keep` nonzero columns, chosen per right-hand side; stops early
    /// when the root of the residual sum of squares is at most `enough`.
    std::vector<double> solve_sparse(int keep, double enough = 0) const;
    /// Orthogonal matching pursuit: repeatedly selects the column that reduces the error most after
    /// orthogonalization against the selected columns. Source: Chen, Billings and Luo 1989,
    /// Orthogonal Least Squares Methods and Their Application to Non-linear System Identification,
    /// Int. J. Control 50(5).
    std::vector<int> choose(int side, int keep, double enough = 0) const;
};

}  // namespace dg
