// monomials.h -- monomials x^a y^b dx^c dy^d in the four coordinates of a ray, up to a degree.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace dg {

inline constexpr int kMaxSeriesDegree = 15;

/// Ordered by degree, then by the power of x, then y, then dx: 1, x, y, dx, dy, x^2, x y ... The
/// code of a monomial is a number with the exponents as digits; the code of a product is the sum of
/// the codes.
class Monomials {
  public:
    static const Monomials& of(int degree);  // cached; degree 0 .. kMaxSeriesDegree

    int degree() const { return degree_; }
    int count() const { return int(exponents_.size()); }
    /// Number of monomials of degree g or less.
    int count_to(int g) const { return end_[g]; }
    int degree_of(int i) const { return degree_of_[i]; }
    const std::array<int, 4>& exponents(int i) const { return exponents_[i]; }

    /// Index of a product; its degree must be at most degree().
    int product(int i, int j) const { return at_code_[code_[i] + code_[j]]; }
    /// Index of monomial i divided by variable v, which it must contain.
    int divided(int i, int v) const { return at_code_[code_[i] - place_[v]]; }
    /// Index of the monomial of a single variable; degree() must be at least 1.
    int variable(int v) const { return at_code_[place_[v]]; }
    /// First variable contained in monomial i > 0.
    int first_variable(int i) const;

  private:
    explicit Monomials(int degree);

    int degree_;
    std::vector<std::array<int, 4>> exponents_;
    std::vector<int> end_, degree_of_, code_;
    std::vector<std::int16_t> at_code_;
    std::array<int, 4> place_;
};

}  // namespace dg
