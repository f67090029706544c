// dual.h -- forward-mode automatic differentiation: a value with its derivatives by N inputs.
#pragma once
#include <array>
#include <cmath>

namespace dg {

template <int N>
struct Dual {
    double value = 0;
    std::array<double, N> d{};

    Dual() = default;
    Dual(double constant) : value(constant) {}  // NOLINT: constants convert implicitly
    static Dual input(double value, int index) {
        Dual x(value);
        x.d[index] = 1;
        return x;
    }

    friend Dual operator+(Dual a, const Dual& b) {
        a.value += b.value;
        for (int i = 0; i < N; ++i) a.d[i] += b.d[i];
        return a;
    }
    friend Dual operator-(Dual a, const Dual& b) {
        a.value -= b.value;
        for (int i = 0; i < N; ++i) a.d[i] -= b.d[i];
        return a;
    }
    friend Dual operator-(const Dual& a) { return a.mapped(-a.value, -1); }
    friend Dual operator*(const Dual& a, const Dual& b) {
        Dual r(a.value * b.value);
        for (int i = 0; i < N; ++i) r.d[i] = a.d[i] * b.value + a.value * b.d[i];
        return r;
    }
    friend Dual operator/(const Dual& a, const Dual& b) {
        Dual r(a.value / b.value);
        for (int i = 0; i < N; ++i) r.d[i] = (a.d[i] - r.value * b.d[i]) / b.value;
        return r;
    }
    /// At 0 the derivative is set to 0: such a root (the radius on the axis) is always multiplied
    /// by a power of itself.
    friend Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.value);
        return a.mapped(root, root > 0 ? 0.5 / root : 0);
    }

  private:
    Dual mapped(double f, double slope) const {
        Dual r(f);
        for (int i = 0; i < N; ++i) r.d[i] = slope * d[i];
        return r;
    }
};

inline double value_of(double x) { return x; }
template <int N>
double value_of(const Dual<N>& x) {
    return x.value;
}

/// Newton steps from an exact root that give it all derivatives of the number type.
inline int newton_steps(double) { return 0; }
template <int N>
int newton_steps(const Dual<N>&) {
    return 1;
}

}  // namespace dg
