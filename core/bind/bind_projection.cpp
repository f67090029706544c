// bind_projection.cpp -- models of calibrated cameras.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>

#include "bind/arrays.h"
#include "camera/projection_model.h"
#include "math/error.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Kind = dg::ProjectionModel::Kind;
using Rows2d = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Rows3d = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Names in the order of ProjectionModel::Kind.
constexpr const char* kNames[] = {"rectilinear", "equidistant",    "equisolid",     "stereographic", "orthographic",
                                  "equirectangular", "cube",       "opencv",        "kannala_brandt", "double_sphere",
                                  "eucm",        "omni",           "fov",           "opencv_inverse", "ftheta"};

dg::ProjectionModel model_of(const std::string& name, const std::vector<double>& parameters) {
    const auto* found = std::find(std::begin(kNames), std::end(kNames), name);
    if (found == std::end(kNames)) throw dg::Error("projection: unknown model '" + name + "'");
    if (parameters.size() > dg::ProjectionModel::kMost)
        throw dg::input_error("projection", "parameters", "at most 14", std::to_string(parameters.size()));
    std::array<double, dg::ProjectionModel::kMost> k{};
    std::copy(parameters.begin(), parameters.end(), k.begin());
    return dg::ProjectionModel(Kind(found - std::begin(kNames)), k);
}

auto project(const dg::ProjectionModel& model, const Rows3d& points) {
    std::vector<double> out;
    out.reserve(2 * points.shape(0));
    for (std::size_t i = 0; i < points.shape(0); ++i) {
        const auto p = model.project({points(i, 0), points(i, 1), points(i, 2)});
        out.push_back(p ? p->x : kNone), out.push_back(p ? p->y : kNone);
    }
    return dg::bind::to_numpy(std::move(out), {points.shape(0), std::size_t(2)});
}

auto unproject(const dg::ProjectionModel& model, const Rows2d& points) {
    std::vector<double> out;
    out.reserve(3 * points.shape(0));
    for (std::size_t i = 0; i < points.shape(0); ++i) {
        const auto d = model.unproject({points(i, 0), points(i, 1)});
        for (const double x : {d ? d->x : kNone, d ? d->y : kNone, d ? d->z : kNone}) out.push_back(x);
    }
    return dg::bind::to_numpy(std::move(out), {points.shape(0), std::size_t(3)});
}

}  // namespace

void bind_projection(nb::module_& m) {
    nb::class_<dg::ProjectionModel>(m, "ProjectionModel")
        .def("__init__",
             [](dg::ProjectionModel* self, const std::string& name, const std::vector<double>& parameters) {
                 new (self) dg::ProjectionModel(model_of(name, parameters));
             },
             "name"_a, "parameters"_a)
        .def_prop_ro("largest_angle", &dg::ProjectionModel::largest_angle, "From the axis, radians.")
        .def_prop_ro("largest_radius", &dg::ProjectionModel::largest_radius, "Focal lengths; may be infinite.")
        .def_prop_ro("is_wide", &dg::ProjectionModel::is_wide)
        .def("project", &project, "directions"_a,
             "Points (N, 2) in focal lengths from the principal point, y down, of directions (N, 3) with z ahead.")
        .def("unproject", &unproject, "points"_a, "Unit directions (N, 3); NaN where nothing is seen.");
}
