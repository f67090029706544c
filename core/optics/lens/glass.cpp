#include "optics/lens/glass.h"

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

// Three-term Cauchy n = A + B x + C x^2, x = 1/lambda^2, that matches nd, nF - nC = (nd-1)/Vd and
// ng - nF = P_gF (nF - nC).
double index_of(const PartialGlass& glass, double nm) {
    const double x = inverse_square(nm), xd = inverse_square(kDesignWavelength);
    const double xf = inverse_square(kLineF), xc = inverse_square(kLineC);
    const double xg = inverse_square(kLineG);
    const double principal = (glass.nd - 1) / glass.vd;
    const double blue = glass.p_gf * principal;
    // Slopes of the chords F-C and g-F; each equals B + C (sum of the chord's ends).
    const double slope_fc = principal / (xf - xc), slope_gf = blue / (xg - xf);
    const double c = (slope_gf - slope_fc) / (xg - xc);
    const double b = slope_fc - c * (xf + xc);
    return glass.nd + b * (x - xd) + c * (x * x - xd * xd);
}

// P_gF on Schott's normal line (Schott TIE-29, eq. for P_g,F).
double index_of(const AbbeGlass& glass, double nm) {
    return index_of(PartialGlass{glass.nd, glass.vd, 0.6438 - 0.001682 * glass.vd}, nm);
}

// Lagrange interpolation through up to four nodes around the wavelength, in x = 1/lambda^2, where
// dispersion is nearly quadratic: exact at every node and continuous; a parabola for three nodes.
double index_of(const TableGlass& glass, double nm) {
    const int count = int(std::min(glass.nm.size(), glass.n.size()));  // equal after check_glass()
    const auto above = std::upper_bound(glass.nm.begin(), glass.nm.begin() + count, nm);
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
    double n2 = 1 + glass.constant;
    for (std::size_t i = 0; i < glass.b.size(); ++i)
        n2 += glass.b[i] * l2 / (l2 - glass.c[i]);
    return std::sqrt(n2);
}

double index_of(const PolynomialGlass& glass, double nm) {
    double n2 = 0;
    for (std::size_t i = 0; i < glass.coefficient.size(); ++i)
        n2 += glass.coefficient[i] * std::pow(1e-3 * nm, glass.power[i]);
    return std::sqrt(n2);
}

double index_of(const MatchedGlass& glass, double nm) {
    double n = std::visit([&](const auto& formula) { return index_of(formula, nm); }, glass.formula);
    if (glass.against_vacuum) n /= air_index(nm);
    return glass.nd + glass.scale * (n - glass.formula_nd);
}

bool ascending(const std::vector<double>& nm) {
    return std::is_sorted(nm.begin(), nm.end(), std::less_equal<>()) && nm.front() > 0;
}

void check_pairs(const std::string& where, const char* what, std::size_t a,
                 std::size_t b) {
    if (a == 0 || a != b)
        throw Error(where + ": " + what + ", got " + std::to_string(b) + " and " +
                    std::to_string(a));
}

void check_formula(const ConstantIndex&, const std::string&) {}

void check_formula(const AbbeGlass& glass, const std::string& where) {
    if (!(glass.vd >= 5))
        throw input_error(where, "Abbe number", "at least 5", std::to_string(glass.vd));
}

void check_formula(const PartialGlass& glass, const std::string& where) {
    check_formula(AbbeGlass{glass.nd, glass.vd}, where);
    if (!(glass.p_gf >= 0.4 && glass.p_gf <= 0.8))
        throw input_error(where, "theta_gF", "0.4 to 0.8", std::to_string(glass.p_gf));
}

void check_formula(const TableGlass& glass, const std::string& where) {
    check_pairs(where, "glass table: wanted as many indices as wavelengths",
                glass.nm.size(), glass.n.size());
    if (!ascending(glass.nm))
        throw Error(where +
                    ": glass table: wanted positive, ascending wavelengths in nm");
}

void check_formula(const SellmeierGlass& glass, const std::string& where) {
    check_pairs(where, "Sellmeier glass: wanted as many b as c, at least one",
                glass.c.size(), glass.b.size());
}

void check_formula(const PolynomialGlass& glass, const std::string& where) {
    check_pairs(where,
                "polynomial glass: wanted as many coefficients as powers, at least one",
                glass.power.size(), glass.coefficient.size());
}

void check_formula(const MatchedGlass& glass, const std::string& where) {
    std::visit([&](const auto& formula) { check_formula(formula, where); }, glass.formula);
}

void check_absorption(const Absorption& a, const std::string& where) {
    if (a.nm.empty() && a.per_mm.empty()) return;
    check_pairs(where, "absorption: wanted as many coefficients as wavelengths",
                a.nm.size(), a.per_mm.size());
    if (!ascending(a.nm))
        throw Error(where + ": absorption: wanted positive, ascending wavelengths in nm");
    for (const double k : a.per_mm)
        if (!(k >= 0 && k <= 1e3))
            throw input_error(where, "absorption", "0 to 1000 per mm", std::to_string(k));
}

}  // namespace

// Standard air of 15 C with 450 ppm CO2: Ciddor 1996, Refractive index of air, Appl. Opt. 35(9),
// eq. 1. Change of density to 20 C: Schott TIE-29, eq. for n_air.
double air_index(double wavelength_nm) {
    const double s2 = inverse_square(wavelength_nm);
    const double at_15 = 0.05792105 / (238.0185 - s2) + 0.00167917 / (57.362 - s2);
    return 1 + at_15 / (1 + 3.4785e-3 * (20 - 15));
}

double refractive_index(const Glass& glass, double wavelength_nm) {
    const double n = std::visit(
        [&](const auto& formula) { return index_of(formula, wavelength_nm); },
        glass.formula);
    return glass.against_vacuum ? n / air_index(wavelength_nm) : n;
}

double absorption_per_mm(const Glass& glass, double wavelength_nm) {
    const std::vector<double>&nm = glass.absorption.nm, &per_mm = glass.absorption.per_mm;
    if (nm.empty()) return 0;
    const auto above = std::upper_bound(nm.begin(), nm.end(), wavelength_nm);
    if (above == nm.begin()) return per_mm.front();
    if (above == nm.end()) return per_mm.back();
    const std::size_t i = above - nm.begin();
    const double u = (wavelength_nm - nm[i - 1]) / (nm[i] - nm[i - 1]);
    return per_mm[i - 1] + u * (per_mm[i] - per_mm[i - 1]);
}

MatchedGlass matched(const Glass& like, double nd, double vd, const std::string& where) {
    check_glass(like, where);
    check_formula(AbbeGlass{nd, vd}, where);
    MatchedGlass found{{}, like.against_vacuum, nd, 0, refractive_index(like, kDesignWavelength)};
    const bool has = std::visit(
        [&](const auto& formula) {
            if constexpr (requires { found.formula = formula; }) return found.formula = formula, true;
            return false;
        },
        like.formula);
    const double spread = refractive_index(like, kLineF) - refractive_index(like, kLineC);
    if (!has || !(spread > 0))
        throw Error(where + ": wanted a glass whose formula or table has dispersion, got " + like.name);
    found.scale = (nd - 1) / vd / spread;
    return found;
}

// Water at 20 C: Daimon and Masumura 2007, Measurement of the refractive index of distilled water,
// Appl. Opt. 46(18); n = 1.33335 against vacuum at 589.3 nm.
Glass water() {
    return {
        SellmeierGlass{{5.684027565e-1, 1.726177391e-1, 2.086189578e-2, 1.130748688e-1},
                       {5.101829712e-3, 1.821153936e-2, 2.620722293e-2, 1.069792721e1}},
        "water",
        {},
        true};
}

Glass vacuum() {
    return {ConstantIndex{1}, "vacuum", {}, true};
}

void check_glass(const Glass& glass, const std::string& where) {
    std::visit([&](const auto& formula) { check_formula(formula, where); },
               glass.formula);
    check_absorption(glass.absorption, where);
    for (double nm = 380; nm <= 780; nm += 25) {
        const double n = refractive_index(glass, nm);
        if (!(n >= 0.99 && n <= 5))
            throw input_error(where,
                              "refractive index at " + std::to_string(int(nm)) + " nm",
                              "1 to 5", std::to_string(n));
    }
}

}  // namespace dg
