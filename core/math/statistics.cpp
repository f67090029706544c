// statistics.cpp -- incomplete gamma and beta functions, and statistical tests. Series and
// continued fractions: Abramowitz and Stegun 1964, 6.5.29, 6.5.31 and 26.5.8; fractions are
// evaluated by Lentz's method (1976) as modified by Thompson and Barnett 1986.
#include "math/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "math/error.h"

namespace dg {
namespace {

constexpr double kEpsilon = 1e-16, kTiny = 1e-300;
constexpr int kMaxTerms = 100000;

/// Continued fraction b0 + a1/(b1 + a2/(b2 + ...)), evaluated term by term.
class Lentz {
  public:
    explicit Lentz(double b0) : value_(b0 == 0 ? kTiny : b0), c_(value_), d_(0) {}
    bool step(double a, double b) {
        d_ = b + a * d_;
        c_ = b + a / c_;
        if (std::abs(d_) < kTiny) d_ = kTiny;
        if (std::abs(c_) < kTiny) c_ = kTiny;
        d_ = 1 / d_;
        value_ *= c_ * d_;
        return std::abs(c_ * d_ - 1) > kEpsilon;
    }
    double value() const { return value_; }

  private:
    double value_, c_, d_;
};

double gamma_series(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < kMaxTerms && term > sum * kEpsilon; ++n)
        sum += term *= x / (a + n);
    return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

double gamma_fraction(double a, double x) {
    Lentz f(x + 1 - a);
    for (int n = 1; n < kMaxTerms && f.step(-n * (n - a), x + 2 * n + 1 - a); ++n) {
    }
    return std::exp(a * std::log(x) - x - std::lgamma(a)) / f.value();
}

double beta_fraction(double a, double b, double x) {
    Lentz f(1);
    for (int n = 1; n < kMaxTerms; ++n) {
        const int m = n / 2;
        const double numerator =
            n % 2 == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                       : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        if (!f.step(numerator, 1)) break;
    }
    return 1 / f.value();
}

}  // namespace

double gamma_p(double a, double x) {
    if (x <= 0) return 0;
    return x < a + 1 ? gamma_series(a, x) : 1 - gamma_fraction(a, x);
}

double gamma_q(double a, double x) {
    if (x <= 0) return 1;
    return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

double incomplete_beta(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x));
    if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double normal_cdf(double z) {
    return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

double student_t_cdf(double t, double degrees) {
    const double tail =
        0.5 * incomplete_beta(degrees / 2, 0.5, degrees / (degrees + t * t));
    return t > 0 ? 1 - tail : tail;
}

double chi_square_tail(double statistic, double degrees) {
    return gamma_q(degrees / 2, statistic / 2);
}

ChiSquareResult chi_square_test(std::span<const double> observed,
                                std::span<const double> expected, int dof_reduction,
                                double min_expected) {
    if (observed.size() != expected.size())
        throw input_error("chi-square test", "cells", std::to_string(expected.size()),
                          std::to_string(observed.size()));
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return expected[a] < expected[b]; });
    ChiSquareResult result;
    int cells = 0, in_pool = 0;
    double pool_observed = 0, pool_expected = 0;
    bool impossible = false;
    const auto close_pool = [&] {
        const double d = pool_observed - pool_expected;
        result.statistic += d * d / pool_expected;
        if (in_pool > 1) result.pooled += in_pool;
        pool_observed = pool_expected = in_pool = 0;
        ++cells;
    };
    double left = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (const std::size_t i : order) {
        impossible |= !(expected[i] > 0) && observed[i] != 0;
        impossible |= std::isnan(observed[i]) || std::isnan(expected[i]);
        pool_observed += observed[i];
        pool_expected += expected[i];
        left -= expected[i];
        ++in_pool;
        // Close the pool only if the remaining cells can fill another; otherwise they join it.
        if (pool_expected >= min_expected && (left >= min_expected || i == order.back()))
            close_pool();
    }
    if (pool_expected > 0) close_pool();
    result.degrees = cells - 1 - dof_reduction;
    if (result.degrees < 1)
        throw input_error("chi-square test", "degrees of freedom", "at least 1",
                          std::to_string(result.degrees));
    result.p_value = impossible ? 0 : chi_square_tail(result.statistic, result.degrees);
    return result;
}

SampleMoments moments(std::span<const double> values) {
    SampleMoments m;
    m.count = double(values.size());
    for (const double v : values) m.mean += v / m.count;
    for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
    m.variance /= std::max(1.0, m.count - 1);
    return m;
}

double welch_p_value(const SampleMoments& a, const SampleMoments& b) {
    const double va = a.variance / a.count, vb = b.variance / b.count;
    if (va + vb <= 0) return a.mean == b.mean ? 1 : 0;
    const double t = (a.mean - b.mean) / std::sqrt(va + vb);
    const double degrees =
        (va + vb) * (va + vb) / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
    return incomplete_beta(degrees / 2, 0.5, degrees / (degrees + t * t));
}

double sidak_level(double alpha, double tests) {
    return -std::expm1(std::log1p(-alpha) / tests);
}

}  // namespace dg
