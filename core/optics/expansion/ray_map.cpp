#include "optics/expansion/ray_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "math/error.h"
#include "math/linear_solve.h"

namespace dg {
namespace {

std::string text(const RayNumbers& ray) {
    std::ostringstream s;
    s << "(" << ray[0] << ", " << ray[1] << ", " << ray[2] << ", " << ray[3] << ")";
    return s.str();
}

/// Values of all monomials at a deviation from the origin.
std::vector<double> monomial_values(const Monomials& m, const RayNumbers& deviation) {
    std::vector<double> value(m.count());
    value[0] = 1;
    for (int i = 1; i < m.count(); ++i) {
        const int v = m.first_variable(i);
        value[i] = deviation[v] * value[m.divided(i, v)];
    }
    return value;
}

RayNumbers minus(const RayNumbers& a, const RayNumbers& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}

/// Outputs of the first map as deviations from the origin of the second.
std::array<Series, 4> joined(const RayMap& second, const RayMap& first) {
    constexpr double kNear = 1e-9;  // mm, radians
    const RayNumbers end = first.image(), gap = minus(end, second.origin);
    for (const double g : gap)
        if (!(std::abs(g) <= kNear))
            throw input_error("polynomial system", "composition",
                              "a second system expanded about the ray on which the first "
                              "ends, " +
                                  text(end),
                              "one about " + text(second.origin));
    std::array<Series, 4> deviation;
    for (int v = 0; v < 4; ++v) deviation[v] = first.out[v] - Series(end[v]);
    return deviation;
}

/// Substitutes the series `inner`, which have no constant terms, into each series of `outer`. Skips
/// unused monomials.
std::array<Series, 4> substitute(const std::array<Series, 4>& outer,
                                 const std::array<Series, 4>& inner) {
    const Monomials& m = *outer[0].monomials();
    std::vector<bool> wanted(m.count());
    for (int i = m.count() - 1; i > 0; --i) {
        for (const Series& s : outer) wanted[i] = wanted[i] || s[i] != 0;
        if (wanted[i]) wanted[m.divided(i, m.first_variable(i))] = true;
    }
    std::array<Series, 4> sum;
    const Series nothing(m, std::vector<double>(m.count()));
    for (int o = 0; o < 4; ++o) sum[o] = nothing + outer[o].value();
    std::vector<Series> power(m.count());
    power[0] = 1;
    for (int i = 1; i < m.count(); ++i) {
        if (!wanted[i]) continue;
        const int v = m.first_variable(i);
        power[i] = power[m.divided(i, v)] * inner[v];
        for (int o = 0; o < 4; ++o)
            if (outer[o][i] != 0) sum[o] = sum[o] + outer[o][i] * power[i];
    }
    return sum;
}

/// Inverse of the linear part, row-major.
std::vector<double> linear_inverse(const RayMap& map) {
    const Matrix4x4 a = map.jacobian(map.origin);
    std::vector<double> matrix, unit(16);
    for (const RayNumbers& row : a) matrix.insert(matrix.end(), row.begin(), row.end());
    for (int k = 0; k < 4; ++k) unit[5 * k] = 1;
    return least_squares(matrix, 4, 4, unit, 4);
}

}  // namespace

RayNumbers RayMap::image() const {
    return {out[0].value(), out[1].value(), out[2].value(), out[3].value()};
}

RayNumbers RayMap::evaluate(const RayNumbers& ray) const {
    const Monomials& m = *out[0].monomials();
    const std::vector<double> value = monomial_values(m, minus(ray, origin));
    RayNumbers sum{};
    for (int o = 0; o < 4; ++o)
        for (int i = 0; i < m.count(); ++i) sum[o] += out[o][i] * value[i];
    return sum;
}

Matrix4x4 RayMap::jacobian(const RayNumbers& ray) const {
    const Monomials& m = *out[0].monomials();
    const std::vector<double> value = monomial_values(m, minus(ray, origin));
    Matrix4x4 j{};
    for (int i = 1; i < m.count(); ++i)
        for (int v = 0; v < 4; ++v) {
            const int power = m.exponents(i)[v];
            if (power == 0) continue;
            const double slope = power * value[m.divided(i, v)];
            for (int o = 0; o < 4; ++o) j[o][v] += out[o][i] * slope;
        }
    return j;
}

std::array<Series, 4> ray_series(int degree, const RayNumbers& about) {
    if (degree < 1 || degree > kMaxSeriesDegree)
        throw input_error("polynomial system", "degree",
                          "1 to " + std::to_string(kMaxSeriesDegree),
                          std::to_string(degree));
    for (const double x : about)
        if (!std::isfinite(x))
            throw input_error("polynomial system", "base ray", "finite numbers",
                              text(about));
    if (!(about[2] * about[2] + about[3] * about[3] < 1))
        throw input_error("polynomial system", "base ray",
                          "direction cosines of a ray that goes forward", text(about));
    const Monomials& m = Monomials::of(degree);
    std::array<Series, 4> s;
    for (int v = 0; v < 4; ++v) s[v] = Series::input(m, about[v], v);
    return s;
}

RayMap truncated(const RayMap& map, int degree) {
    if (degree == map.degree()) return map;
    const Monomials& m = Monomials::of(degree);
    RayMap cut{map.origin, {}};
    for (int o = 0; o < 4; ++o) {
        std::vector<double> c(m.count());
        for (int i = 0; i < m.count(); ++i) c[i] = map.out[o][i];
        cut.out[o] = Series(m, std::move(c));
    }
    return cut;
}

RayMap compose(const RayMap& second, const RayMap& first) {
    const int degree = std::min(second.degree(), first.degree());
    const RayMap inner = truncated(first, degree);
    return {first.origin,
            substitute(truncated(second, degree).out, joined(second, inner))};
}

// With out - image = A d + N(d), iterates d = A^-1 (out - image - N(d)); each round makes one more
// degree exact.
RayMap inverse(const RayMap& map) {
    const int degree = map.degree();
    const RayNumbers image = map.image();
    const std::vector<double> a = linear_inverse(map);
    std::array<Series, 4> variable = ray_series(degree, {}), bent;
    for (int o = 0; o < 4; ++o) {
        bent[o] = map.out[o] - image[o];
        for (int v = 0; v < 4; ++v) {
            const int i = variable[v].monomials()->variable(v);
            bent[o] = bent[o] - map.out[o][i] * variable[v];
        }
    }
    const auto solved = [&](const std::array<Series, 4>& right) {
        std::array<Series, 4> d;
        for (int o = 0; o < 4; ++o)
            d[o] = a[4 * o] * right[0] + a[4 * o + 1] * right[1] +
                   a[4 * o + 2] * right[2] + a[4 * o + 3] * right[3];
        return d;
    };
    std::array<Series, 4> d = solved(variable);
    for (int round = 1; round < degree; ++round) {
        const std::array<Series, 4> known = substitute(bent, d);
        std::array<Series, 4> right;
        for (int o = 0; o < 4; ++o) right[o] = variable[o] - known[o];
        d = solved(right);
    }
    for (int o = 0; o < 4; ++o) d[o] = d[o] + map.origin[o];
    return {image, d};
}

}  // namespace dg
