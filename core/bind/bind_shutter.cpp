// bind_shutter.cpp -- opening curves and shutters.
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "camera/shutter.h"
#include "math/error.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

dg::ScanOrder scan_order(const std::string& name) {
    if (name == "none") return dg::ScanOrder::none;
    if (name == "top") return dg::ScanOrder::top;
    if (name == "bottom") return dg::ScanOrder::bottom;
    if (name == "left") return dg::ScanOrder::left;
    if (name == "right") return dg::ScanOrder::right;
    throw dg::input_error("shutter", "scan order", "none, top, bottom, left or right", name);
}

}  // namespace

void bind_shutter(nb::module_& m) {
    using namespace dg;
    nb::class_<OpeningCurve>(m, "OpeningCurve", "Opening 0..1 over the time for which a point is exposed.")
        .def(nb::init<>(), "Open all the time.")
        .def_static("trapezoid", &OpeningCurve::trapezoid, "efficiency"_a)
        .def_static("points",
                    [](const Values& u, const Values& s) {
                        return OpeningCurve::points({u.data(), u.size()}, {s.data(), s.size()});
                    },
                    "u"_a, "s"_a)
        .def_prop_ro("mean", &OpeningCurve::mean)
        .def_prop_ro("nodes",
                     [](const OpeningCurve& c) {
                         std::vector<std::tuple<double, double>> points;
                         for (std::size_t i = 0; i < c.places().size(); ++i)
                             points.emplace_back(c.places()[i], c.values()[i]);
                         return points;
                     });
    nb::class_<Shutter>(m, "Shutter")
        .def(nb::init<>())
        .def("__init__",
             [](Shutter* s, double exposure_s, const OpeningCurve& curve, const std::string& scan,
                double line_time_s, bool leaf, std::tuple<int, int> resolution) {
                 new (s) Shutter({exposure_s, curve, scan_order(scan), line_time_s, leaf},
                                 std::get<0>(resolution), std::get<1>(resolution));
             },
             "exposure_s"_a, "curve"_a, "scan"_a, "line_time_s"_a, "leaf"_a, "resolution"_a)
        .def("within", &Shutter::within, "pixels_left"_a, "pixels_above"_a,
             "That of a larger frame around this one, whose other pixels are exposed with the nearest line.")
        .def_prop_ro("duration_s", &Shutter::duration_s)
        .def_prop_ro("weight", &Shutter::weight)
        .def("moment",
             [](const Shutter& s, int x, int y, float u) {
                 const Moment moment = s.draw(x, y, u);
                 return std::tuple{moment.time, moment.iris_opening};
             },
             "x"_a, "y"_a, "u"_a, "Fraction of the duration, and of the iris's radius, of a pixel's sample.");
}
