#include "optics/aim/free_basis.h"

#include "math/linear_solve.h"

namespace dg {
namespace {

constexpr int kMaxPower = 15;

struct Powers {
    double of[5][kMaxPower + 1];
    Powers(const FreeSlopeSample& s, int degree) {
        const double base[5] = {s.a.x, s.a.y, s.f.x, s.f.y, s.l};
        for (int v = 0; v < 5; ++v) {
            of[v][0] = 1;
            for (int e = 1; e <= degree; ++e) of[v][e] = of[v][e - 1] * base[v];
        }
    }
};

}  // namespace

int free_term_count(int degree) {
    int count = 0;
    for_each_free_term(degree, [&](int, int, int, int, int) { ++count; });
    return count;
}

// Nested Horner scheme; the two outer loops also accumulate the derivatives by a.x and a.y.
SlopeValue FreePolynomial::evaluate(Vec2d f, Vec2d a, double l) const {
    const double* c = coefficients.data();
    Vec2d m{}, by_x{}, by_y{};
    for (int i = degree; i >= 0; --i) {
        Vec2d row{}, row_by_y{};
        for (int j = degree - i; j >= 0; --j) {
            Vec2d at_film{};
            for (int p = degree - i - j; p >= 0; --p) {
                Vec2d in_y{};
                for (int q = degree - i - j - p; q >= 0; --q) {
                    Vec2d in_l{};
                    for (int r = (degree - i - j - p - q) / 2; r >= 0; --r, c += 2)
                        in_l = in_l * l + Vec2d{c[0], c[1]};
                    in_y = in_y * f.y + in_l;
                }
                at_film = at_film * f.x + in_y;
            }
            row_by_y = row_by_y * a.y + row;
            row = row * a.y + at_film;
        }
        by_x = by_x * a.x + m;
        m = m * a.x + row;
        by_y = by_y * a.x + row_by_y;
    }
    SlopeValue v;
    v.m = m;
    v.m11 = by_x.x, v.m21 = by_x.y, v.m12 = by_y.x, v.m22 = by_y.y;
    v.jacobian = v.m11 * v.m22 - v.m12 * v.m21;
    return v;
}

FreePolynomial fit_free_slopes(const std::vector<FreeSlopeSample>& samples, int degree) {
    const int terms = free_term_count(degree), rows = int(samples.size());
    std::vector<double> matrix, rhs;
    matrix.reserve(std::size_t(rows) * terms);
    for (const FreeSlopeSample& s : samples) {
        const Powers power(s, degree);
        for_each_free_term(degree, [&](int i, int j, int p, int q, int r) {
            matrix.push_back(power.of[0][i] * power.of[1][j] * power.of[2][p] *
                             power.of[3][q] * power.of[4][r]);
        });
        rhs.insert(rhs.end(), {s.m.x, s.m.y});
    }
    return {degree, least_squares(matrix, rows, terms, rhs, 2)};
}

}  // namespace dg
