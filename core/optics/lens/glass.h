// glass.h -- refractive index against wavelength. Wavelengths in nm, as everywhere in
// optics.
#pragma once
#include <string>
#include <variant>
#include <vector>

namespace dg {

inline constexpr double kDesignWavelength = 587.5618;  // nm, helium d line

/// The same index at every wavelength: air (1), or a glass whose Abbe number is unknown.
struct ConstantIndex {
    double n = 1;
};

/// Only nd and the Abbe number Vd are known: three-term Cauchy on Schott's normal line.
struct AbbeGlass {
    double nd, vd;
};

/// nd, Vd and P_gF = (ng - nF) / (nF - nC), which patents call theta_gF: three-term Cauchy.
struct PartialGlass {
    double nd, vd, p_gf;
};

/// Measured indices; exact at the nodes. Nodes ascend in wavelength.
struct TableGlass {
    std::vector<double> nm, n;
};

/// n^2 = 1 + constant + sum b_i l^2 / (l^2 - c_i), l in um, c in um^2: any number of terms
/// (makers' catalogues; formula 2 of refractiveindex.info, and formula 1 with c squared).
struct SellmeierGlass {
    std::vector<double> b, c;
    double constant = 0;
};

/// n^2 = sum coefficient_i * l^power_i, l in um: Schott's polynomial of 1966 (powers 0, 2,
/// -2, -4, -6, -8) and its extensions by other makers (formula 3 of refractiveindex.info).
struct PolynomialGlass {
    std::vector<double> coefficient, power;
};

/// Dispersion of a catalogue's glass, shifted and scaled to the nd and Vd of a lens file:
/// n = nd + (n of the catalogue - nd of the catalogue) * ratio of nF - nC.
struct MatchedGlass {
    std::variant<TableGlass, SellmeierGlass, PolynomialGlass> formula;
    bool against_vacuum = false;   // the formula
    double nd, scale, formula_nd;
};

/// Absorption of glass along the way: exp(-per_mm * path). Nodes ascend; the
/// coefficient is linear between them, hence the internal transmittance is interpolated in
/// its logarithm; beyond them it stays as it is at the end. Empty: clear glass.
struct Absorption {
    std::vector<double> nm, per_mm;
};

/// Catalogues state indices relative to air (of 20 C and 101.325 kPa), and so does
/// everything in optics/: air has n = 1. Data that are relative to vacuum say so here.
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

/// Dispersion of `like` at nd and Vd. Throws Error (with `where`) if `like` has none: a
/// constant, or a glass that is itself known by its Abbe number.
MatchedGlass matched(const Glass& like, double nd, double vd, const std::string& where);

Glass water();   // pure, of 20 C
Glass vacuum();  // n = 1 / air_index

inline bool is_air(const Glass& glass) {
    const auto* constant = std::get_if<ConstantIndex>(&glass.formula);
    return constant && constant->n == 1 && !glass.against_vacuum;
}

/// Throws Error (with `where`) unless formula and absorption make sense and the index lies
/// in [0.99, 5] over 380-780 nm.
void check_glass(const Glass& glass, const std::string& where);

}  // namespace dg
