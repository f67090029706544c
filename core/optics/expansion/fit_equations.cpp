#include "optics/expansion/fit_equations.h"

#include <algorithm>
#include <cmath>

#include "math/linear_solve.h"

namespace dg {
namespace {

constexpr double kDependent =
    1e-20;  // least part of a column's squared length that is independent of the chosen columns

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

void take_out(std::vector<double>& from, const std::vector<double>& unit) {
    const double share = product(from, unit);
    for (std::size_t i = 0; i < from.size(); ++i) from[i] -= share * unit[i];
}

}  // namespace

std::vector<double> FitEquations::solve() const {
    return least_squares(matrix, rows(), columns, rhs, sides);
}

std::vector<int> FitEquations::choose(int side, int keep, double enough) const {
    std::vector<std::vector<double>> column(columns, std::vector<double>(rows()));
    std::vector<double> rest(rows()), length(columns);
    for (int i = 0; i < rows(); ++i) {
        rest[i] = rhs[std::size_t(i) * sides + side];
        for (int j = 0; j < columns; ++j)
            column[j][i] = matrix[std::size_t(i) * columns + j];
    }
    for (int j = 0; j < columns; ++j) length[j] = product(column[j], column[j]);
    std::vector<int> chosen;
    while (int(chosen.size()) < std::min(keep, columns) &&
           product(rest, rest) > enough * enough) {
        int best = -1;
        double most = 0;
        for (int j = 0; j < columns; ++j) {
            const double left = product(column[j], column[j]),
                         along = product(column[j], rest);
            if (!(left > kDependent * length[j]) || !(along * along > most * left))
                continue;
            best = j, most = along * along / left;
        }
        if (best < 0) break;
        chosen.push_back(best);
        std::vector<double> unit = std::move(column[best]);
        const double scale = 1 / std::sqrt(product(unit, unit));
        for (double& v : unit) v *= scale;
        column[best].assign(rows(), 0.0);
        take_out(rest, unit);
        for (int j = 0; j < columns; ++j)
            if (length[j] > 0) take_out(column[j], unit);
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

std::vector<double> FitEquations::solve_sparse(int keep, double enough) const {
    std::vector<double> x(std::size_t(columns) * sides);
    for (int side = 0; side < sides; ++side) {
        const std::vector<int> chosen = choose(side, keep, enough);
        FitEquations few{int(chosen.size()), 1};
        for (int i = 0; i < rows(); ++i) {
            for (const int j : chosen)
                few.matrix.push_back(matrix[std::size_t(i) * columns + j]);
            few.rhs.push_back(rhs[std::size_t(i) * sides + side]);
        }
        if (chosen.empty()) continue;
        const std::vector<double> found = few.solve();
        for (std::size_t k = 0; k < chosen.size(); ++k)
            x[std::size_t(chosen[k]) * sides + side] = found[k];
    }
    return x;
}

}  // namespace dg
