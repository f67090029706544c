// bind_spectrum.cpp -- colour tables of spectra.
#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "bind/arrays.h"
#include "spectrum/sampled_spectrum.h"
#include "spectrum/wavelengths.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Row = std::array<double, 7>;

Row colour_row(double nm) {
    const dg::Vec3d basis = dg::rgb_basis(nm);
    return {dg::cie_x(nm), dg::cie_y(nm), dg::cie_z(nm), dg::d65(nm), basis.x, basis.y, basis.z};
}

}  // namespace

void bind_spectrum(nb::module_& m) {
    nb::class_<dg::SampledSpectrum>(m, "SampledSpectrum", "A value by wavelength, in the core's form.")
        .def("__init__",
             [](dg::SampledSpectrum* s, const std::vector<double>& nm, const std::vector<double>& values) {
                 new (s) dg::SampledSpectrum(nm, values);
             },
             "wavelengths_nm"_a, "values"_a);
    m.def("colour_tables",
          [](const std::vector<double>& nm) {
              std::vector<double> rows;
              for (const double l : nm)
                  for (const double v : colour_row(l)) rows.push_back(v);
              return dg::bind::to_numpy(std::move(rows), {nm.size(), std::tuple_size_v<Row>});
          },
          "wavelengths_nm"_a,
          "CIE x, y, z and D65 as published, and the basis of upsampled red, green, blue, (L, 7).");
    m.def("rgb_from_xyz",
          [](std::array<float, 3> xyz) {
              const dg::Rgb rgb = dg::rgb_from_xyz({xyz[0], xyz[1], xyz[2]});
              return std::array<float, 3>{rgb.x, rgb.y, rgb.z};
          },
          "xyz"_a, "Linear Rec.709 of one colour; D65 is (1, 1, 1).");
}
