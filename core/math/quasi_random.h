// quasi_random.h -- low-discrepancy sequences: multiples of powers of 1/g, g^(N+1) = g + 1. Source:
// Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences.
#pragma once
#include <array>
#include <cmath>

namespace dg {

/// Point n in [0, 1)^N, N 4 or 5.
template <int N>
std::array<double, N> quasi_random(int n) {
    static_assert(N == 4 || N == 5);
    constexpr double g = N == 4 ? 1.1673039782614187 : 1.1347241384015194;
    std::array<double, N> point;
    double step = 1;
    for (double& u : point) {
        step /= g;
        u = 0.5 + step * (n + 1);
        u -= std::floor(u);
    }
    return point;
}

}  // namespace dg
