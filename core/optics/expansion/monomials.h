// monomials.h -- the monomials of a ray's four numbers, x^a y^b dx^c dy^d, up to a
// degree.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace dg {

inline constexpr int kMaxSeriesDegree = 15;

/// By degree, within a degree by the power of x, then y, then dx: 1, x, y, dx, dy, x^2, x
/// y ... The exponents are also the digits of a number, the code, so that a product adds
/// codes.
class Monomials {
  public:
    static const Monomials& of(int degree);  // made once; 0 .. kMaxSeriesDegree

    int degree() const { return degree_; }
    int count() const { return int(exponents_.size()); }
    /// How many there are of degree g and less: those of degree g end here.
    int count_to(int g) const { return end_[g]; }
    int degree_of(int i) const { return degree_of_[i]; }
    const std::array<int, 4>& exponents(int i) const { return exponents_[i]; }

    /// Index of a product of degree() at most.
    int product(int i, int j) const { return at_code_[code_[i] + code_[j]]; }
    /// Index of monomial i divided by variable v, of which it must hold a power.
    int divided(int i, int v) const { return at_code_[code_[i] - place_[v]]; }
    /// Index of a variable alone. Degree 1 at least.
    int variable(int v) const { return at_code_[place_[v]]; }
    /// A variable that monomial i > 0 holds: the first one.
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
