// glass.h -- refractive index and absorption of glass by wavelength. Wavelengths are in nm
// throughout optics.
#pragma once
#include <string>
#include <variant>
#include <vector>

namespace dg {

inline constexpr double kDesignWavelength = 587.5618;  // nm, helium d line

/// Dispersion-free index: air (1), or a glass without a known Abbe number.
struct ConstantIndex {
    double n = 1;
};

/// Glass known by nd and Abbe number Vd: three-term Cauchy formula with P_gF on Schott's normal
/// line.
struct AbbeGlass {
    double nd, vd;
};

/// Glass known by nd, Vd and P_gF = (ng - nF) / (nF - nC), theta_gF in patents: three-term Cauchy
/// formula.
struct PartialGlass {
    double nd, vd, p_gf;
};

/// Interpolated measurements; exact at the nodes, which ascend in wavelength.
struct TableGlass {
    std::vector<double> nm, n;
};

/// Sellmeier formula n^2 = 1 + constant + sum b_i l^2 / (l^2 - c_i) with any number of terms, l in
/// um, c in um^2 (makers' catalogues; formula 2 of refractiveindex.info, and formula 1 with c
/// squared).
struct SellmeierGlass {
    std::vector<double> b, c;
    double constant = 0;
};

/// n^2 = sum coefficient_i * l^power_i, l in um: Schott's polynomial of 1966 (powers 0, 2, -2, -4,
/// -6, -8) and other makers' extensions (formula 3 of refractiveindex.info).
struct PolynomialGlass {
    std::vector<double> coefficient, power;
};

/// Dispersion of a catalogue glass, shifted and scaled to the nd and Vd of a lens file: n = nd +
/// scale (n_formula - nd_formula), where scale is the ratio of nF - nC.
struct MatchedGlass {
    std::variant<TableGlass, SellmeierGlass, PolynomialGlass> formula;
    bool against_vacuum = false;   // whether the formula gives the index against vacuum
    double nd, scale, formula_nd;
};

/// Internal transmittance exp(-per_mm * path). The coefficient is interpolated linearly between
/// ascending nodes (so the transmittance is interpolated in its logarithm) and constant beyond
/// them. Empty: clear glass.
struct Absorption {
    std::vector<double> nm, per_mm;
};

/// Optical material. Indices are relative to air of 20 C and 101.325 kPa, as in catalogues: air has
/// n = 1 throughout optics. `against_vacuum` marks formulas for the index against vacuum.
struct Glass {
    std::variant<ConstantIndex, AbbeGlass, TableGlass, SellmeierGlass, PolynomialGlass, PartialGlass,
                 MatchedGlass>
        formula;
    std::string name;
    Absorption absorption = {};
    bool against_vacuum = false;
};

/// Index at a wavelength in nm, relative to air.
double refractive_index(const Glass& glass, double wavelength_nm);

/// Absorption coefficient in 1/mm (base e).
double absorption_per_mm(const Glass& glass, double wavelength_nm);

/// Index of dry air of 20 C and 101.325 kPa against vacuum.
double air_index(double wavelength_nm);

/// Dispersion of `like`, fitted to nd and Vd. Throws Error (with `where`) if `like` is a constant
/// index or is known by its Abbe number only.
MatchedGlass matched(const Glass& like, double nd, double vd, const std::string& where);

Glass water();   // pure, at 20 C
Glass vacuum();  // n = 1 / air_index

inline bool is_air(const Glass& glass) {
    const auto* constant = std::get_if<ConstantIndex>(&glass.formula);
    return constant && constant->n == 1 && !glass.against_vacuum;
}

/// Throws Error (with `where`) if the formula or the absorption is invalid, or the index leaves
/// [0.99, 5] over 380-780 nm.
void check_glass(const Glass& glass, const std::string& where);

}  // namespace dg
