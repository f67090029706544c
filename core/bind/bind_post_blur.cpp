// bind_post_blur.cpp -- depth of field and motion blur in post.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "post/defocus.h"
#include "post/motion_blur.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Colours = nb::ndarray<const float, nb::shape<-1, -1, 4>, nb::c_contig, nb::device::cpu>;
using Plane = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Flow = nb::ndarray<const float, nb::shape<-1, -1, 2>, nb::c_contig, nb::device::cpu>;
using Corners = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

template <typename Array>
std::span<const float> values_of(const Array& array) {
    return {array.data(), array.size()};
}

void same_size(const Colours& image, std::size_t height, std::size_t width, const char* what) {
    if (image.shape(0) != height || image.shape(1) != width)
        throw dg::input_error("post", what, "the height and width of the picture",
                              std::to_string(height) + " x " + std::to_string(width));
}

dg::IrisShape outline(const Corners& corners) {
    std::vector<dg::Vec2d> points;
    for (std::size_t i = 0; i < corners.shape(0); ++i)
        points.push_back({corners.data()[2 * i], corners.data()[2 * i + 1]});
    return dg::IrisShape::outline(points);
}

dg::SpreadRows rows_of(const Colours& image, std::pair<int, int> rows) {
    const auto [begin, end] = rows;
    if (!(0 <= begin && begin < end && std::size_t(end) <= image.shape(0)))
        throw dg::input_error("post", "rows", "rows of the picture",
                              std::to_string(begin) + " to " + std::to_string(end));
    return {begin, end};
}

/// Rows computed by `make` without the interpreter's lock.
template <typename Make>
auto made_rows(const Colours& image, dg::SpreadRows rows, const Make& make) {
    std::vector<float> out;
    {
        dg::bind::Unlocked release;
        out = make();
    }
    return dg::bind::to_numpy(std::move(out),
                              {std::size_t(rows.end - rows.begin), image.shape(1), image.shape(2)});
}

auto defocus(const Colours& image, const Plane& radius, const dg::IrisShape& iris, std::pair<int, int> rows) {
    same_size(image, radius.shape(0), radius.shape(1), "radius");
    const dg::SpreadRows wanted = rows_of(image, rows);
    return made_rows(image, wanted, [&] {
        return dg::defocus(int(image.shape(1)), values_of(image), values_of(radius), iris, wanted);
    });
}

auto motion_blur(const Colours& image, const Flow& next, const Flow& last, const Plane& nearness, float step,
                 const dg::ShutterTime& shutter, std::pair<int, int> rows) {
    same_size(image, next.shape(0), next.shape(1), "motion");
    same_size(image, last.shape(0), last.shape(1), "motion");
    same_size(image, nearness.shape(0), nearness.shape(1), "nearness");
    const dg::SpreadRows wanted = rows_of(image, rows);
    return made_rows(image, wanted, [&] {
        return dg::motion_blur(int(image.shape(1)), values_of(image), {values_of(next), values_of(last)},
                               values_of(nearness), step, shutter, wanted);
    });
}

}  // namespace

void bind_post_blur(nb::module_& m) {
    nb::class_<dg::IrisShape>(m, "IrisShape")
        .def_static("outline", &outline, "corners"_a, "A closed line, counterclockwise, y up.")
        .def_static(
            "image",
            [](const Plane& values) {
                return dg::IrisShape::image(int(values.shape(1)), int(values.shape(0)), values_of(values));
            },
            "values"_a, "Transmittances, row 0 at the top.")
        .def_ro("outer_radius", &dg::IrisShape::outer_radius);
    m.def("defocus", &defocus, "image"_a, "radius"_a, "iris"_a, "rows"_a,
          "Pixels (H, W, 4) spread by the iris; radius (H, W) in px, positive before the focus.");
    m.def("rounded_blur", &dg::IrisKernels::rounded, "radius"_a, "The radius that stands for this one in defocus, px.");
    nb::class_<dg::ShutterTime>(m, "ShutterTime")
        .def(nb::init<double, double, std::vector<double>>(), "open"_a, "close"_a, "arrived"_a,
             "open, close: in frames. arrived: shares of the light, at equal steps of that time.");
    m.def("motion_blur", &motion_blur, "image"_a, "next"_a, "last"_a, "nearness"_a, "step"_a,
          "shutter"_a, "rows"_a, "Pixels (H, W, 4) spread along motion (H, W, 2) in px per frame.");
}
