// linear_solve.h -- dense linear least squares in double.
#pragma once
#include <vector>

namespace dg {

/// Minimizes |A x - b| for each right-hand side by Householder reflections. Scalar double
/// without contraction: the same bits on every machine. matrix: row-major, rows x cols.
/// rhs: row-major, rows x nrhs. Returns cols x nrhs, row-major. Throws Error if rows <
/// cols, a size is wrong, a number is not finite, or a column depends on those before it
/// (what is left of it is below 1e-13 of its length).
std::vector<double> least_squares(const std::vector<double>& matrix, int rows, int cols,
                                  const std::vector<double>& rhs, int nrhs);

}  // namespace dg
