#include "optics/expansion/series.h"

#include <cmath>
#include <span>

#include "math/error.h"

namespace dg {
namespace {

/// Nonzero terms of an operand, by degree. Symmetry leaves few.
struct Terms {
    std::vector<int> index;
    std::array<int, kMaxSeriesDegree + 1> end{};

    Terms(const Monomials& m, const std::vector<double>& c, int first) {
        int i = first;
        for (int g = 0; g <= m.degree(); ++g) {
            for (; i < m.count_to(g); ++i)
                if (c[i] != 0) index.push_back(i);
            end[g] = int(index.size());
        }
    }
    /// Terms of degree g or less.
    std::span<const int> to(int g) const { return {index.data(), std::size_t(end[g])}; }
};

/// Monomials of the non-constant operands, which must agree.
const Monomials* shared(const Series& a, const Series& b) {
    if (a.monomials() && b.monomials()) DG_CHECK(a.degree(), ==, b.degree());
    return a.monomials() ? a.monomials() : b.monomials();
}

}  // namespace

Series Series::input(const Monomials& monomials, double value, int v) {
    std::vector<double> c(monomials.count());
    c[0] = value;
    if (monomials.degree() > 0) c[monomials.variable(v)] = 1;
    return {monomials, std::move(c)};
}

Series Series::plus(double factor, const Series& b) const {
    shared(*this, b);
    const bool longer = b.c_.size() > c_.size();
    Series sum = longer ? b.scaled(factor) : *this;
    const Series& other = longer ? *this : b;
    for (std::size_t i = 0; i < other.c_.size(); ++i)
        sum.c_[i] += longer ? other.c_[i] : factor * other.c_[i];
    return sum;
}

Series Series::scaled(double factor) const {
    Series r = *this;
    for (double& c : r.c_) c *= factor;
    return r;
}

Series operator*(const Series& a, const Series& b) {
    const Monomials* m = shared(a, b);
    if (!a.monomials_) return b.scaled(a.value());
    if (!b.monomials_) return a.scaled(b.value());
    const Terms ta(*m, a.c_, 0), tb(*m, b.c_, 0);
    std::vector<double> c(m->count());
    for (const int i : ta.index)
        for (const int j : tb.to(m->degree() - m->degree_of(i)))
            c[m->product(i, j)] += a.c_[i] * b.c_[j];
    return {*m, std::move(c)};
}

// Solves r b = a from low to high degrees: subtracts the contribution of each known term of r from
// all higher terms.
Series operator/(const Series& a, const Series& b) {
    const Monomials* m = shared(a, b);
    if (!b.monomials_) return a.scaled(1 / b.value());
    const Terms tb(*m, b.c_, 1);
    std::vector<double> r(a.c_);
    r.resize(m->count());
    for (int i = 0; i < m->count(); ++i) {
        if (r[i] == 0) continue;
        r[i] /= b.c_[0];
        for (const int j : tb.to(m->degree() - m->degree_of(i)))
            r[m->product(i, j)] -= b.c_[j] * r[i];
    }
    return {*m, std::move(r)};
}

// Solves s s = a in the same order: subtracts products of pairs of known terms of s.
Series sqrt(const Series& a) {
    if (!(a.value() > 0))
        throw Error("no power series: the root of a number that is not positive");
    const double root = std::sqrt(a.value());
    if (!a.monomials_) return root;
    const Monomials& m = *a.monomials_;
    std::vector<double> s(a.c_);
    std::vector<int> known;  // nonzero terms beyond the constant
    s[0] = root;
    for (int i = 1; i < m.count(); ++i) {
        if (s[i] == 0) continue;
        s[i] /= 2 * root;
        known.push_back(i);
        const int left = m.degree() - m.degree_of(i);
        for (const int j : known) {
            if (m.degree_of(j) > left) break;
            s[m.product(i, j)] -= (i == j ? 1 : 2) * s[i] * s[j];
        }
    }
    return {m, std::move(s)};
}

}  // namespace dg
