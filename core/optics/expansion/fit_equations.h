// fit_equations.h -- least squares problems of a fit, complete or with few terms.
#pragma once
#include <vector>

namespace dg {

/// Rows of a matrix and of right-hand sides.
struct FitEquations {
    int columns = 0, sides = 0;
    std::vector<double> matrix{}, rhs{};

    int rows() const { return int(rhs.size()) / sides; }
    /// [column][side].
    std::vector<double> solve() const;
    /// The same with at most `keep` columns that are not 0, chosen for each side by
    /// itself; fewer once the root of what they leave, summed in squares, is `enough`.
    std::vector<double> solve_sparse(int keep, double enough = 0) const;
    /// Orthogonal matching pursuit: column after column the one that lowers the error
    /// most, once what it has in common with those before is taken out. Source: Chen,
    /// Billings and Luo 1989, Orthogonal Least Squares Methods and Their Application to
    /// Non-linear System Identification, Int. J. Control 50(5).
    std::vector<int> choose(int side, int keep, double enough = 0) const;
};

}  // namespace dg
