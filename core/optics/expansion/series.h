// series.h -- truncated power series in the four coordinates of a ray: a number type like
// math/dual.h. The tracer's templates run on it and give Taylor expansions of any degree, without
// formulas per surface.
#pragma once
#include <vector>

#include "optics/expansion/monomials.h"

namespace dg {

/// Sum of coefficient x monomial; all operations truncate to the degree. A constant has no degree
/// and combines with any series; two series must have the same degree.
class Series {
  public:
    Series(double constant = 0) : c_{constant} {}  // NOLINT: constants convert implicitly
    Series(const Monomials& monomials, std::vector<double> coefficients)
        : monomials_(&monomials), c_(std::move(coefficients)) {}
    /// value + variable v.
    static Series input(const Monomials& monomials, double value, int v);

    double value() const { return c_[0]; }
    /// Null for a constant.
    const Monomials* monomials() const { return monomials_; }
    double operator[](int i) const { return i < int(c_.size()) ? c_[i] : 0; }
    int degree() const { return monomials_ ? monomials_->degree() : 0; }

    friend Series operator+(const Series& a, const Series& b) { return a.plus(1, b); }
    friend Series operator-(const Series& a, const Series& b) { return a.plus(-1, b); }
    friend Series operator-(const Series& a) { return a.scaled(-1); }
    friend Series operator*(const Series& a, const Series& b);
    friend Series operator/(const Series& a, const Series& b);
    /// The constant term must be positive, since sqrt has no expansion elsewhere.
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

/// Newton steps needed from an exact value: each step doubles the exact degree.
inline int newton_steps(const Series& x) {
    int steps = 0;
    for (int right = 0; right < x.degree(); right = 2 * right + 1) ++steps;
    return steps;
}

}  // namespace dg
