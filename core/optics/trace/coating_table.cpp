#include "optics/trace/coating_table.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace dg {
namespace {

/// Coefficients [row][column] of a polynomial in two variables.
struct Grid {
    int rows, columns;
    std::vector<double> values = std::vector<double>(std::size_t(rows) * columns);
    double& at(int j, int m) { return values[std::size_t(j) * columns + m]; }
};

double node(int i, int count) {
    return std::cos(kPiD * (i + 0.5) / count);
}

/// Transforms values at Chebyshev points to Chebyshev coefficients, along one axis.
void to_chebyshev(double* v, int count, int stride) {
    std::vector<double> in(count), cosine(4 * count);
    for (int i = 0; i < count; ++i) in[i] = v[i * stride];
    for (int i = 0; i < 4 * count; ++i) cosine[i] = std::cos(0.5 * kPiD * i / count);
    for (int k = 0; k < count; ++k) {
        double sum = 0;
        for (int i = 0; i < count; ++i) sum += in[i] * cosine[k * (2 * i + 1) % (4 * count)];
        v[k * stride] = sum * (k ? 2.0 : 1.0) / count;
    }
}

/// Converts a Chebyshev series to a power series, along one axis (Clenshaw's recurrence, expanded).
void to_powers(double* v, int count, int stride) {
    std::vector<double> a(count + 1), b(count + 1), next(count + 1);
    for (int k = count - 1; k >= 0; --k) {  // next = 2 t a - b + v_k, at last t a - b + v_0
        const double factor = k ? 2 : 1;
        for (int i = 0; i <= count; ++i)
            next[i] = (i ? factor * a[i - 1] : v[k * stride]) - b[i];
        b = a, a = next;
    }
    for (int i = 0; i < count; ++i) v[i * stride] = a[i];
}

/// Number of coefficients kept per row. Drops coefficients from the ends of rows, smallest first,
/// while the sum of the dropped magnitudes is below the tolerance. A row is never longer than the
/// row before: the conversion to powers adds coefficients of a row to the rows before it.
std::vector<int> kept_terms(Grid& c, double tolerance) {
    std::vector<int> kept(c.rows, c.columns);
    for (double left = tolerance;;) {
        int best = -1;
        double least = left;
        for (int j = 0; j < c.rows; ++j) {
            const bool corner = kept[j] > (j + 1 < c.rows ? kept[j + 1] : 0);
            if (!corner || std::abs(c.at(j, kept[j] - 1)) > least) continue;
            best = j, least = std::abs(c.at(j, kept[j] - 1));
        }
        if (best < 0) break;
        left -= least, --kept[best];
    }
    while (kept.size() > 1 && kept.back() == 0) kept.pop_back();
    return kept;
}

}  // namespace

CoatingTable fit_coating_table(const std::function<std::function<double(double)>(double)>& at,
                         double n, double phase, double tolerance) {
    const double pole = std::sqrt(1 + n * n);
    // cos(phase l) needs a degree of about its argument, plus a margin for the coefficients' decay.
    // Nearly equal indices bend the curve close to grazing incidence.
    Grid c{n > 1.2 ? 14 : 18, int(13 + 2.2 * phase)};
    for (int m = 0; m < c.columns; ++m) {
        const auto transmittance = at(node(m, c.columns));
        for (int j = 0; j < c.rows; ++j) {
            const double cosine = 0.5 * (1 + node(j, c.rows));
            const double root = 1 + pole * cosine;
            c.at(j, m) = transmittance(cosine) * root * root / cosine;
        }
    }
    for (int m = 0; m < c.columns; ++m) to_chebyshev(&c.at(0, m), c.rows, c.columns);
    for (int j = 0; j < c.rows; ++j) to_chebyshev(&c.at(j, 0), c.columns, 1);
    // c / (1 + pole c)^2 <= 1 / (4 pole), so errors of P are scaled down by that factor.
    const std::vector<int> kept = kept_terms(c, tolerance * 4 * pole);
    for (int j = 0; j < c.rows; ++j)
        for (int m = j < int(kept.size()) ? kept[j] : 0; m < c.columns; ++m) c.at(j, m) = 0;
    for (int m = 0; m < c.columns; ++m) to_powers(&c.at(0, m), c.rows, c.columns);
    for (int j = 0; j < c.rows; ++j) to_powers(&c.at(j, 0), c.columns, 1);
    CoatingTable table{float(pole), {}, {}};
    for (int j = int(kept.size()) - 1; j >= 0; --j) {
        table.terms.push_back(kept[j]);
        for (int m = kept[j] - 1; m >= 0; --m)
            table.coefficients.push_back(float(c.at(j, m)));
    }
    return table;
}

}  // namespace dg
