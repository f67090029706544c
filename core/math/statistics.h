// statistics.h -- the distributions behind the statistical tests of every room.
#pragma once
#include <cstdint>
#include <span>

namespace dg {

/// Regularized incomplete gamma functions P(a, x) and Q(a, x) = 1 - P; a > 0, x >= 0.
double gamma_p(double a, double x);
double gamma_q(double a, double x);
/// Regularized incomplete beta function I_x(a, b); a, b > 0, x in [0,1].
double incomplete_beta(double a, double b, double x);

double normal_cdf(double z);
double student_t_cdf(double t, double degrees);
/// Probability that a chi-square variable of `degrees` exceeds `statistic`.
double chi_square_tail(double statistic, double degrees);

struct ChiSquareResult {
    double statistic = 0;
    int degrees = 0;  // cells after pooling, minus 1, minus dof_reduction
    double p_value =
        0;           // probability of a statistic at least this large if the law is right
    int pooled = 0;  // cells that were thrown together
};

/// Pearson's test of counts against expected counts. Cells are taken in the order of
/// their expectation and pooled until each holds at least `min_expected`; a count where
/// nothing can fall is p = 0. `dof_reduction`: parameters that were estimated from the
/// counts. Throws Error if the sizes differ or fewer than two cells remain.
ChiSquareResult chi_square_test(std::span<const double> observed,
                                std::span<const double> expected, int dof_reduction = 0,
                                double min_expected = 5);

/// Sample mean with the unbiased variance of one observation, and how many there were.
struct SampleMoments {
    double mean = 0, variance = 0, count = 0;
};
SampleMoments moments(std::span<const double> values);

/// Two-sided p-value that two means are equal, variances unknown and different.
/// Source: Welch 1947, Biometrika 34. Both variances 0: 1 if the means are equal, else 0.
double welch_p_value(const SampleMoments& a, const SampleMoments& b);

/// Level of each of n independent tests that keeps the chance of any false alarm at
/// `alpha`. Source: Sidak 1967, JASA 62.
double sidak_level(double alpha, double tests);

}  // namespace dg
