// bind_first_order.cpp -- first-order data, focus and Seidel sums of a prescription.
#include "bind/bind_first_order.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "math/error.h"
#include "optics/first_order/best_focus.h"
#include "optics/first_order/seidel.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

dg::Section section_from_name(const std::string& name) {
    if (name != "x" && name != "y")
        throw dg::input_error("first order", "section", "x or y", name);
    return name == "x" ? dg::Section::x : dg::Section::y;
}

dg::FocusFrom focus_from(bool sensor) {
    return sensor ? dg::FocusFrom::sensor : dg::FocusFrom::pupil;
}

/// Seidel sums (surfaces, 7): S1 to S5, C1, C2; totals are the column sums.
auto seidel_sums(const dg::Prescription& lens, double wavelength_nm, double pupil_radius,
                 double field_slope, double object_distance, double short_nm, double long_nm) {
    const dg::Seidel sums =
        dg::seidel(lens, wavelength_nm, {pupil_radius, field_slope, object_distance}, short_nm,
                   long_nm);
    std::vector<double> rows;
    for (const dg::SeidelSums& s : sums.surfaces)
        rows.insert(rows.end(), {s.s1, s.s2, s.s3, s.s4, s.s5, s.c1, s.c2});
    return nb::make_tuple(dg::bind::to_numpy(std::move(rows), {sums.surfaces.size(), 7}),
                          sums.invariant, sums.image_convergence);
}

void bind_record(nb::module_& m) {
    using dg::FirstOrder;
    nb::class_<FirstOrder>(m, "FirstOrder")
        .def_ro("wavelength_nm", &FirstOrder::wavelength_nm)
        .def_ro("efl", &FirstOrder::efl)
        .def_ro("bfl", &FirstOrder::bfl)
        .def_ro("ffl", &FirstOrder::ffl)
        .def_ro("front_focal_z", &FirstOrder::front_focal_z)
        .def_ro("back_focal_z", &FirstOrder::back_focal_z)
        .def_ro("front_principal_z", &FirstOrder::front_principal_z)
        .def_ro("back_principal_z", &FirstOrder::back_principal_z)
        .def_ro("front_nodal_z", &FirstOrder::front_nodal_z)
        .def_ro("back_nodal_z", &FirstOrder::back_nodal_z)
        .def_ro("entrance_pupil_z", &FirstOrder::entrance_pupil_z)
        .def_ro("exit_pupil_z", &FirstOrder::exit_pupil_z)
        .def_ro("entrance_pupil_diameter", &FirstOrder::entrance_pupil_diameter)
        .def_ro("exit_pupil_diameter", &FirstOrder::exit_pupil_diameter)
        .def_ro("stop_semi_diameter", &FirstOrder::stop_semi_diameter)
        .def_ro("f_number", &FirstOrder::f_number)
        .def_prop_ro("pupil_magnification", &dg::pupil_magnification,
                     "Exit pupil / entrance pupil, signed.");
}

}  // namespace

void bind_first_order(nb::module_& m, nb::class_<dg::Prescription>& lens) {
    using namespace dg;
    bind_record(m);
    lens.def(
            "first_order",
            [](const Prescription& lens, double wavelength_nm, const std::string& section) {
                return first_order(lens, wavelength_nm, section_from_name(section));
            },
            "wavelength_nm"_a, "section"_a = "y")
        .def(
            "film_position",
            [](const Prescription& lens, double distance_m, bool from_sensor) {
                return film_position(lens, first_order(lens), distance_m,
                                     focus_from(from_sensor));
            },
            "distance_m"_a, "from_sensor"_a)
        .def(
            "closest_focus_m",
            [](const Prescription& lens, bool from_sensor) {
                return closest_focus_m(lens, first_order(lens), focus_from(from_sensor));
            },
            "from_sensor"_a)
        .def(
            "best_focus",
            [](const Prescription& lens, double f_stop, double distance_m, bool from_sensor,
               const std::vector<std::pair<double, double>>& wavelengths) {
                std::vector<WeightedWavelength> weighted;
                for (const auto& [nm, weight] : wavelengths) weighted.push_back({nm, weight});
                if (weighted.empty()) weighted = kEyeWavelengths;
                const BestFocus best =
                    best_focus(lens, f_stop, distance_m, focus_from(from_sensor), weighted);
                return std::pair(best.film_z, best.rms);
            },
            "f_stop"_a, "distance_m"_a, "from_sensor"_a = false,
            "wavelengths"_a = std::vector<std::pair<double, double>>{},
            "z of the film (mm) with the smallest RMS spot on the axis, and that RMS (mm). "
            "wavelengths: pairs of nm and weight; F, d and C by what the eye makes of them if "
            "empty.")
        .def("seidel", &seidel_sums, "wavelength_nm"_a, "pupil_radius"_a, "field_slope"_a,
             "object_distance"_a = std::numeric_limits<double>::infinity(),
             "short_nm"_a = 486.1327, "long_nm"_a = 656.2725,
             "Sums of each surface, (surfaces, 7): S1 to S5, C1, C2, mm of wavefront; the "
             "invariant; n'u' behind the lens.");
}
