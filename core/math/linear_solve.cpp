// linear_solve.cpp -- Householder QR of a tall matrix, in panels of rows.
//
// The triangle R is updated panel by panel: the reflection of column j only changes row j of R and
// the panel. The cost is 2 m n^2, as for QR of the whole matrix, but the working set fits the
// cache. Source: Golub and Van Loan 2013, Matrix Computations, 5.1 and 6.5.
#include "math/linear_solve.h"

#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr int kPanelRows = 64;  // 64 x 80 doubles fit the L1 cache

/// Panel in column-major order. Unused rows of the last panel are 0 and have no effect.
struct Panel {
    std::vector<double> values;
    explicit Panel(int columns) : values(std::size_t(columns) * kPanelRows) {}
    double* column(int j) { return values.data() + std::size_t(j) * kPanelRows; }
};

using Pair [[gnu::vector_size(16)]] = double;

/// Explicit partial sums in four pairs: the compiler may not reorder floating-point additions
/// itself.
double dot_panel(const double* a, const double* b) {
    Pair s[4] = {};
    for (int i = 0; i < kPanelRows; i += 8)
        for (int k = 0; k < 4; ++k) {
            const Pair x{a[i + 2 * k], a[i + 2 * k + 1]},
                y{b[i + 2 * k], b[i + 2 * k + 1]};
            s[k] += x * y;
        }
    const Pair t = (s[0] + s[1]) + (s[2] + s[3]);
    return t[0] + t[1];
}

void subtract_multiple(double* a, const double* v, double factor) {
    for (int i = 0; i < kPanelRows; ++i) a[i] -= factor * v[i];
}

/// Reflects (R row j; panel) so that column j of the panel becomes 0, and applies the reflection to
/// all columns from j on. The reflector is v = (1; p / head) with head = r - alpha, where the sign
/// of alpha avoids cancellation.
void annihilate_column(std::vector<double>& r, Panel& panel, int j, int columns) {
    double* p = panel.column(j);
    const double below = dot_panel(p, p);
    if (below == 0) return;
    double* row = r.data() + std::size_t(j) * columns;
    const double norm = std::sqrt(row[j] * row[j] + below);
    const double alpha = row[j] > 0 ? -norm : norm;
    const double head = row[j] - alpha;
    for (int i = 0; i < kPanelRows; ++i) p[i] /= head;
    const double beta = -head / alpha;
    row[j] = alpha;
    for (int k = j + 1; k < columns; ++k) {
        const double projection = beta * (row[k] + dot_panel(p, panel.column(k)));
        row[k] -= projection;
        subtract_multiple(panel.column(k), p, projection);
    }
}

void check_input(const std::vector<double>& matrix, int rows, int cols,
                 const std::vector<double>& rhs, int nrhs) {
    const auto expect = [](const char* what, std::size_t wanted, std::size_t got) {
        if (wanted != got)
            throw input_error("least squares", what, std::to_string(wanted) + " numbers",
                              std::to_string(got));
    };
    if (rows < cols || cols < 1 || nrhs < 1)
        throw input_error("least squares", "shape",
                          "rows >= columns >= 1, right-hand sides >= 1",
                          std::to_string(rows) + " x " + std::to_string(cols) + ", " +
                              std::to_string(nrhs));
    expect("matrix", std::size_t(rows) * cols, matrix.size());
    expect("right-hand sides", std::size_t(rows) * nrhs, rhs.size());
    double sum = 0;  // sum of products with 0: NaN if any number is not finite
    for (const double v : matrix) sum += v * 0;
    for (const double v : rhs) sum += v * 0;
    if (sum != 0)
        throw input_error("least squares", "values", "finite numbers", "NaN or infinity");
}

void load_panel(Panel& panel, const double* source, int stride, int first_column,
                int count) {
    for (int k = 0; k < stride; ++k) {
        double* column = panel.column(first_column + k);
        for (int i = 0; i < count; ++i) column[i] = source[std::size_t(i) * stride + k];
        for (int i = count; i < kPanelRows; ++i) column[i] = 0;
    }
}

}  // namespace

std::vector<double> least_squares(const std::vector<double>& matrix, int rows, int cols,
                                  const std::vector<double>& rhs, int nrhs) {
    check_input(matrix, rows, cols, rhs, nrhs);
    const int columns = cols + nrhs;
    std::vector<double> r(std::size_t(cols) * columns), squares(cols);
    Panel panel(columns);
    for (int first = 0; first < rows; first += kPanelRows) {
        const int count = std::min(kPanelRows, rows - first);
        load_panel(panel, matrix.data() + std::size_t(first) * cols, cols, 0, count);
        load_panel(panel, rhs.data() + std::size_t(first) * nrhs, nrhs, cols, count);
        for (int j = 0; j < cols; ++j)
            squares[j] += dot_panel(panel.column(j), panel.column(j));
        for (int j = 0; j < cols; ++j) annihilate_column(r, panel, j, columns);
    }
    std::vector<double> x(std::size_t(cols) * nrhs);
    for (int j = cols - 1; j >= 0; --j) {
        const double* row = r.data() + std::size_t(j) * columns;
        if (!(std::abs(row[j]) > 1e-13 * std::sqrt(squares[j])))
            throw input_error("least squares", "column " + std::to_string(j),
                              "independent of the columns before it",
                              "a dependent column");
        for (int s = 0; s < nrhs; ++s) {
            double sum = row[cols + s];
            for (int k = j + 1; k < cols; ++k)
                sum -= row[k] * x[std::size_t(k) * nrhs + s];
            x[std::size_t(j) * nrhs + s] = sum / row[j];
        }
    }
    return x;
}

}  // namespace dg
