// statistics.h -- distributions and tests for the statistical tests of all rooms.
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
    int degrees = 0;  // cells after pooling - 1 - dof_reduction
    double p_value =
        0;           // probability of a statistic at least this large under the null hypothesis
    int pooled = 0;  // number of pooled cells
};

/// Pearson's chi-square test of counts against expected counts. Sorts cells by expectation and
/// pools them until each has at least `min_expected`; a count in a cell of expectation 0 gives p =
/// 0. `dof_reduction`: number of parameters estimated from the counts. Throws Error if the sizes
/// differ or fewer than two cells remain.
ChiSquareResult chi_square_test(std::span<const double> observed,
                                std::span<const double> expected, int dof_reduction = 0,
                                double min_expected = 5);

/// Sample mean, unbiased variance of an observation, and number of observations.
struct SampleMoments {
    double mean = 0, variance = 0, count = 0;
};
SampleMoments moments(std::span<const double> values);

/// Two-sided p-value of equal means with unknown and different variances. Source: Welch 1947,
/// Biometrika 34. If both variances are 0: 1 for equal means, else 0.
double welch_p_value(const SampleMoments& a, const SampleMoments& b);

/// Significance level of each of n independent tests for a family-wise level `alpha`. Source: Sidak
/// 1967, JASA 62.
double sidak_level(double alpha, double tests);

}  // namespace dg
