// linear_solve.h -- dense linear least squares in double.
#pragma once
#include <vector>

namespace dg {

/// Minimizes |A x - b| for each right-hand side by Householder QR. Scalar double without
/// contraction: bitwise equal on all machines. matrix: row-major, rows x cols. rhs: row-major, rows
/// x nrhs. Returns cols x nrhs, row-major. Throws Error if rows < cols, a size is wrong, a number
/// is not finite, or a column is linearly dependent on the columns before it (its residual is below
/// 1e-13 of its length).
std::vector<double> least_squares(const std::vector<double>& matrix, int rows, int cols,
                                  const std::vector<double>& rhs, int nrhs);

}  // namespace dg
