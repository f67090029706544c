#include "develop/poisson.h"

#include <array>
#include <cmath>

namespace dg {
namespace {

constexpr double kLarge = 10;   // mean from which rejection is valid and faster

/// Inversion of the distribution function, term by term from 0.
double by_inversion(double mean, PixelRandom& random) {
    double u = random.uniform(), term = std::exp(-mean);
    int k = 0;
    while (u > term && k < 200) {   // beyond 200, terms of a mean below 10 are negligible
        u -= term;
        term *= mean / ++k;
    }
    return k;
}

/// Logarithm of k!, by a table and Stirling's series (Abramowitz and Stegun 1964, 6.1.41), with an
/// error below 1e-12. std::lgamma is not thread-safe: it writes a global sign.
double log_factorial(double k) {
    static const std::array<double, 16> table = [] {
        std::array<double, 16> t{};
        for (int i = 2; i < 16; ++i) t[i] = t[i - 1] + std::log(double(i));
        return t;
    }();
    if (k < 16) return table[int(k)];
    const double n = k + 1, n2 = n * n;
    const double tail = (1. / 12 - (1. / 360 - (1. / 1260 - 1. / (1680 * n2)) / n2) / n2) / n;
    return (n - 0.5) * std::log(n) - n + 0.5 * std::log(2 * kPiD) + tail;
}

/// Transformed rejection with a squeeze. Source: Hoermann 1993, The transformed rejection method
/// for generating Poisson random variables, algorithm PTRS, with its constants and letters.
double by_rejection(double mean, PixelRandom& random) {
    const double b = 0.931 + 2.53 * std::sqrt(mean), a = -0.059 + 0.02483 * b;
    const double v_r = 0.9277 - 3.6224 / (b - 2);
    for (;;) {
        const double u = random.uniform() - 0.5, v = random.uniform();
        const double us = 0.5 - std::abs(u);
        const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
        if (us >= 0.07 && v <= v_r) return k;
        if (k < 0 || (us < 0.013 && v > us)) continue;
        const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
        if (std::log(v * inverse_alpha / (a / (us * us) + b)) <=
            k * std::log(mean) - mean - log_factorial(k))
            return k;
    }
}

}  // namespace

double poisson(double mean, PixelRandom& random) {
    return mean < kLarge ? by_inversion(mean, random) : by_rejection(mean, random);
}

}  // namespace dg
