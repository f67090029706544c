// series.h -- a truncated power series in the four numbers of a ray: a number type like
// math/dual.h, on which the tracer's own templates run. What comes out is the Taylor
// expansion of what they compute, to any degree, without tables of formulas.
#pragma once
#include <vector>

#include "optics/expansion/monomials.h"

namespace dg {

/// The sum over monomials of coefficient x monomial; higher degrees are dropped wherever
/// they arise. A constant knows no degree and goes with any series; series meet only
/// their like.
class Series {
  public:
    Series(double constant = 0) : c_{constant} {}  // NOLINT: constants mix with series
    Series(const Monomials& monomials, std::vector<double> coefficients)
        : monomials_(&monomials), c_(std::move(coefficients)) {}
    /// value + variable v.
    static Series input(const Monomials& monomials, double value, int v);

    double value() const { return c_[0]; }
    /// Null: a constant.
    const Monomials* monomials() const { return monomials_; }
    double operator[](int i) const { return i < int(c_.size()) ? c_[i] : 0; }
    int degree() const { return monomials_ ? monomials_->degree() : 0; }

    friend Series operator+(const Series& a, const Series& b) { return a.plus(1, b); }
    friend Series operator-(const Series& a, const Series& b) { return a.plus(-1, b); }
    friend Series operator-(const Series& a) { return a.scaled(-1); }
    friend Series operator*(const Series& a, const Series& b);
    friend Series operator/(const Series& a, const Series& b);
    /// The constant term must be positive: elsewhere a root has no expansion.
    friend Series sqrt(const Series& a);

  private:
    Series plus(double factor, const Series& b) const;
    Series scaled(double factor) const;

    const Monomials* monomials_ = nullptr;
    std::vector<double> c_;
};

inline double value_of(const Series& x) {
    return x.value();
}

/// Each step of Newton's doubles the degree that is right, from the value alone.
inline int newton_steps(const Series& x) {
    int steps = 0;
    for (int right = 0; right < x.degree(); right = 2 * right + 1) ++steps;
    return steps;
}

}  // namespace dg
