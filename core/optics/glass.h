// glass.h -- refractive index against wavelength. Wavelengths in nm, as everywhere in
// optics.
#pragma once
#include <array>
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

/// Measured indices; exact at the nodes. Nodes ascend in wavelength.
struct TableGlass {
    std::vector<double> nm, n;
};

/// n^2 = 1 + sum b_i l^2 / (l^2 - c_i), l in um, c in um^2 (makers' catalogues).
struct SellmeierGlass {
    std::array<double, 3> b, c;
};

struct Glass {
    std::variant<ConstantIndex, AbbeGlass, TableGlass, SellmeierGlass> formula;
    std::string name;
};

/// Index at a wavelength in nm (air has n = 1: catalogue indices are relative to air).
double refractive_index(const Glass& glass, double wavelength_nm);

inline bool is_air(const Glass& glass) {
    const auto* constant = std::get_if<ConstantIndex>(&glass.formula);
    return constant && constant->n == 1;
}

/// Throws Error (with `where`) unless the index lies in [1, 5] over 380-780 nm.
void check_glass(const Glass& glass, const std::string& where);

}  // namespace dg
