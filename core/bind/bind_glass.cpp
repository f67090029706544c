// bind_glass.cpp -- glass: index and absorption against wavelength.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "optics/lens/glass.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Numbers = std::vector<double>;

/// A glass, validated immediately.
dg::Glass checked(dg::Glass glass) {
    dg::check_glass(glass, "glass");
    return glass;
}

dg::Glass sellmeier(Numbers b, Numbers c, double constant) {
    return checked({dg::SellmeierGlass{std::move(b), std::move(c), constant}, ""});
}

dg::Glass polynomial(Numbers coefficients, Numbers powers) {
    return checked(
        {dg::PolynomialGlass{std::move(coefficients), std::move(powers)}, ""});
}

dg::Glass with_absorption(dg::Glass glass, Numbers wavelength_nm, Numbers per_mm) {
    glass.absorption = {std::move(wavelength_nm), std::move(per_mm)};
    return checked(std::move(glass));
}

dg::Glass against_vacuum(dg::Glass glass) {
    glass.against_vacuum = true;
    return checked(std::move(glass));
}

}  // namespace

void bind_glass(nb::module_& m) {
    using namespace dg;
    m.def("air_index", &air_index, "wavelength_nm"_a,
          "Index of dry air of 20 C and 101.325 kPa against vacuum.");
    nb::class_<Glass>(m, "Glass")
        .def_static(
            "constant",
            [](double n) {
                return Glass{ConstantIndex{n}, ""};
            },
            "n"_a)
        .def_static(
            "abbe",
            [](double nd, double vd) {
                return Glass{AbbeGlass{nd, vd}, ""};
            },
            "nd"_a, "vd"_a)
        .def_static(
            "partial",
            [](double nd, double vd, double theta_gf) {
                return checked(Glass{PartialGlass{nd, vd, theta_gf}, ""});
            },
            "nd"_a, "vd"_a, "theta_gf"_a)
        .def_static(
            "matched",
            [](const Glass& like, double nd, double vd) {
                return checked(Glass{matched(like, nd, vd, "glass"), ""});
            },
            "like"_a, "nd"_a, "vd"_a, "The dispersion of a glass, shifted and scaled to nd and Vd.")
        .def_static(
            "table",
            [](Numbers nm, Numbers n) {
                return Glass{TableGlass{std::move(nm), std::move(n)}, ""};
            },
            "wavelength_nm"_a, "n"_a)
        .def_static("sellmeier", &sellmeier, "b"_a, "c_um2"_a, "constant"_a = 0.0,
                    "n^2 = 1 + constant + sum b l^2 / (l^2 - c), l in um.")
        .def_static("polynomial", &polynomial, "coefficients"_a, "powers"_a,
                    "n^2 = sum coefficient * l^power, l in um.")
        .def_static("water", &water)
        .def_static("vacuum", &vacuum)
        .def("with_absorption", &with_absorption, "wavelength_nm"_a, "per_mm"_a,
             "The same glass that swallows light: coefficients of base e, 1/mm.")
        .def(
            "with_absorption_of",
            [](Glass glass, const Glass& other) {
                glass.absorption = other.absorption;
                return glass;
            },
            "other"_a, "The same glass with the absorption of another.")
        .def("against_vacuum", &against_vacuum,
             "The same data, taken as relative to vacuum instead of air.")
        .def_prop_ro("absorbs",
                     [](const Glass& glass) { return !glass.absorption.nm.empty(); })
        .def("index", &refractive_index, "wavelength_nm"_a)
        .def("absorption_per_mm", &absorption_per_mm, "wavelength_nm"_a);
}
