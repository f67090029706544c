#include "optics/aim/symmetric_basis.h"

#include "math/linear_solve.h"

namespace dg {

int term_count(int k) {
    int count = 0;
    for_each_term(k, [&](int, int, int, int) { ++count; });
    return count;
}

// Nested Horner scheme that also accumulates the derivatives by s and W, in the order of
// for_each_term.
SlopeValue SlopePolynomial::evaluate(double r, Vec2d a, double l) const {
    const double U = 2 * r * r - 1, s = r * a.x, W = 2 * dot(a, a) - 1;
    const double* c = coefficients.data();
    double value[2] = {}, by_s[2] = {}, by_w[2] = {};
    for (int i = k; i >= 0; --i) {
        double in_w[2] = {}, in_w_slope[2] = {};
        for (int j = k - i; j >= 0; --j) {
            double in_u[2] = {};
            for (int p = k - i - j; p >= 0; --p) {
                double in_l[2] = {};
                for (int q = (k - i - j - p) / 2; q >= 0; --q, c += 2)
                    for (int o = 0; o < 2; ++o) in_l[o] = in_l[o] * l + c[o];
                for (int o = 0; o < 2; ++o) in_u[o] = in_u[o] * U + in_l[o];
            }
            for (int o = 0; o < 2; ++o) {
                in_w_slope[o] = in_w_slope[o] * W + in_w[o];
                in_w[o] = in_w[o] * W + in_u[o];
            }
        }
        for (int o = 0; o < 2; ++o) {
            by_s[o] = by_s[o] * s + value[o];
            value[o] = value[o] * s + in_w[o];
            by_w[o] = by_w[o] * s + in_w_slope[o];
        }
    }
    const double dwx = 4 * a.x, dwy = 4 * a.y;
    const double along = r * by_w[0] + a.x * by_w[1];  // factor of grad W in dm_x
    const double across = a.y * by_w[1];
    SlopeValue v;
    v.m = {r * value[0] + a.x * value[1], a.y * value[1]};
    v.m11 = value[1] + r * (r * by_s[0] + a.x * by_s[1]) + along * dwx;
    v.m12 = along * dwy;
    v.m21 = a.y * by_s[1] * r + across * dwx;
    v.m22 = value[1] + across * dwy;
    v.jacobian = v.m11 * v.m22 - v.m12 * v.m21;
    return v;
}

SlopePolynomial fit_slopes(const std::vector<SlopeSample>& samples, int k) {
    const int terms = term_count(k), columns = 2 * terms, rows = 2 * int(samples.size());
    std::vector<double> matrix(std::size_t(rows) * columns), rhs(rows);
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const SlopeSample& sample = samples[n];
        double power[4][16];
        const double base[4] = {sample.r * sample.a.x, 2 * dot(sample.a, sample.a) - 1,
                                2 * sample.r * sample.r - 1, sample.l};
        for (int v = 0; v < 4; ++v) {
            power[v][0] = 1;
            for (int e = 1; e <= k; ++e) power[v][e] = power[v][e - 1] * base[v];
        }
        double* x = &matrix[2 * n * columns];
        double* y = x + columns;
        for_each_term(k, [&](int i, int j, int p, int q) {
            const double t = power[0][i] * power[1][j] * power[2][p] * power[3][q];
            *x++ = sample.r * t, *x++ = sample.a.x * t;
            *y++ = 0, *y++ = sample.a.y * t;
        });
        rhs[2 * n] = sample.m.x, rhs[2 * n + 1] = sample.m.y;
    }
    return {k, least_squares(matrix, rows, columns, rhs, 1)};
}

}  // namespace dg
