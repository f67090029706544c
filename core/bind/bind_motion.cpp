// bind_motion.cpp -- transforms over time.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include "bind/arrays.h"
#include "math/error.h"
#include "motion/motion.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Times = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrices = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;
using Triple = std::array<double, 3>;

dg::Vec3d vec(const Triple& v) { return {v[0], v[1], v[2]}; }

dg::Interpolation interpolation(const std::string& name) {
    if (name == "linear") return dg::Interpolation::linear;
    if (name == "twist") return dg::Interpolation::twist;
    if (name == "slerp") return dg::Interpolation::slerp;
    if (name == "decomposed") return dg::Interpolation::decomposed;
    throw dg::input_error("motion", "interpolation", "linear, twist, slerp or decomposed", name);
}

dg::Motion from_keys(const Times& times, const Matrices& matrices, const std::string& how,
                     const Triple& pivot) {
    std::vector<dg::Affine3d> keys;
    keys.reserve(matrices.shape(0));
    for (std::size_t i = 0; i < matrices.shape(0); ++i)
        keys.push_back(dg::bind::to_affine(matrices.data() + 16 * i));
    return dg::Motion::keys({times.data(), times.size()}, keys, interpolation(how), vec(pivot));
}

std::array<double, 16> matrix_at(const dg::Motion& motion, double time) {
    const dg::Affine3d m = motion.at(time);
    return {m.x.x, m.y.x, m.z.x, m.origin.x, m.x.y, m.y.y, m.z.y, m.origin.y,
            m.x.z, m.y.z, m.z.z, m.origin.z, 0, 0, 0, 1};
}

auto one_matrix(const dg::Motion& motion, double time) {
    const auto m = matrix_at(motion, time);
    return dg::bind::to_numpy<double>({m.begin(), m.end()}, {4, 4});
}

auto matrices(const dg::Motion& motion, const Times& times) {
    std::vector<double> all;
    all.reserve(16 * times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
        const auto m = matrix_at(motion, times(i));
        all.insert(all.end(), m.begin(), m.end());
    }
    return dg::bind::to_numpy(std::move(all), {times.size(), std::size_t(4), std::size_t(4)});
}

}  // namespace

void bind_motion(nb::module_& m) {
    using dg::Motion;
    nb::class_<Motion>(m, "Motion")
        .def_static("still", [](const dg::bind::Matrix4& m) { return Motion(dg::bind::to_affine(m)); },
                    "matrix"_a)
        .def_static("keys", &from_keys, "times"_a, "matrices"_a, "interpolation"_a = "decomposed",
                    "pivot"_a = Triple{0, 0, 0},
                    "times (K,) s that do not fall (two equal ones: a jump), matrices (K, 4, 4).")
        .def("spinning",
             [](const Motion& m, const Triple& axis, double revolutions_per_second,
                const Triple& center, double time) {
                 return m.spinning({vec(axis), revolutions_per_second, vec(center), time});
             },
             "axis"_a, "revolutions_per_second"_a, "center"_a = Triple{0, 0, 0}, "time"_a = 0.0)
        .def("relative_to",
             [](const Motion& m, const Triple& world_origin) { return m.relative_to(vec(world_origin)); },
             "world_origin"_a, "The same in a world with its origin at this point, m.")
        .def_prop_ro("moves", &Motion::moves)
        .def("over", &Motion::over, "open"_a, "close"_a,
             "The same with open (s) as time 0 and close as 1; still if it does not move in between.")
        .def("at", &one_matrix, "time"_a, "(4, 4) at a time, s.")
        .def("many", &matrices, "times"_a, "(T, 4, 4) at times (T,), s.");
}
