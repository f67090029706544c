#include "optics/glass.h"

#include <algorithm>
#include <cmath>

#include "math/error.h"

namespace dg {
namespace {

constexpr double kLineF = 486.1327, kLineC = 656.2725, kLineG = 435.8343;  // nm

double inverse_square(double nm) {
    return 1e6 / (nm * nm);
}  // um^-2

double index_of(const ConstantIndex& glass, double) {
    return glass.n;
}

// n = A + B x + C x^2, x = 1/lambda^2, through nd, through nF - nC = (nd-1)/Vd and
// through ng - nF = P_gF (nF - nC) with P_gF of Schott's normal line (Schott TIE-29, eq.
// for P_g,F).
double index_of(const AbbeGlass& glass, double nm) {
    const double x = inverse_square(nm), xd = inverse_square(kDesignWavelength);
    const double xf = inverse_square(kLineF), xc = inverse_square(kLineC);
    const double xg = inverse_square(kLineG);
    const double principal = (glass.nd - 1) / glass.vd;
    const double blue = (0.6438 - 0.001682 * glass.vd) * principal;
    // Slopes of the two chords: B + C (sum of their ends).
    const double slope_fc = principal / (xf - xc), slope_gf = blue / (xg - xf);
    const double c = (slope_gf - slope_fc) / (xg - xc);
    const double b = slope_fc - c * (xf + xc);
    return glass.nd + b * (x - xd) + c * (x * x - xd * xd);
}

// Lagrange through the (up to) four nodes around the wavelength, in x = 1/lambda^2, where
// glass is nearly a parabola: exact at every node, continuous, and a plain parabola for
// three nodes.
double index_of(const TableGlass& glass, double nm) {
    const int count = int(glass.nm.size());
    const auto above = std::upper_bound(glass.nm.begin(), glass.nm.end(), nm);
    const int first =
        std::clamp(int(above - glass.nm.begin()) - 2, 0, std::max(0, count - 4));
    const int last = std::min(count, first + 4);
    const double x = inverse_square(nm);
    double sum = 0;
    for (int i = first; i < last; ++i) {
        double basis = 1;
        const double xi = inverse_square(glass.nm[i]);
        for (int j = first; j < last; ++j)
            if (j != i)
                basis *= (x - inverse_square(glass.nm[j])) /
                         (xi - inverse_square(glass.nm[j]));
        sum += basis * glass.n[i];
    }
    return sum;
}

double index_of(const SellmeierGlass& glass, double nm) {
    const double l2 = 1 / inverse_square(nm);
    double n2 = 1;
    for (int i = 0; i < 3; ++i) n2 += glass.b[i] * l2 / (l2 - glass.c[i]);
    return std::sqrt(n2);
}

}  // namespace

double refractive_index(const Glass& glass, double wavelength_nm) {
    return std::visit(
        [&](const auto& formula) { return index_of(formula, wavelength_nm); },
        glass.formula);
}

void check_glass(const Glass& glass, const std::string& where) {
    if (const auto* table = std::get_if<TableGlass>(&glass.formula)) {
        if (table->nm.empty() || table->nm.size() != table->n.size())
            throw Error(where +
                        ": glass table: wanted as many indices as wavelengths, got " +
                        std::to_string(table->n.size()) + " and " +
                        std::to_string(table->nm.size()));
        if (!std::is_sorted(table->nm.begin(), table->nm.end(), std::less_equal<>()) ||
            !(table->nm.front() > 0))
            throw Error(where +
                        ": glass table: wanted positive, ascending wavelengths in nm");
    }
    if (const auto* abbe = std::get_if<AbbeGlass>(&glass.formula);
        abbe && !(abbe->vd >= 5))
        throw input_error(where, "Abbe number", "at least 5", std::to_string(abbe->vd));
    for (double nm = 380; nm <= 780; nm += 25) {
        const double n = refractive_index(glass, nm);
        if (!(n >= 1 && n <= 5))
            throw input_error(where,
                              "refractive index at " + std::to_string(int(nm)) + " nm",
                              "1 to 5", std::to_string(n));
    }
}

}  // namespace dg
