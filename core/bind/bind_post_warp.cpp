// bind_post_warp.cpp -- warps pictures by maps.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "post/remap.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

template <typename T, typename... Shape>
using Array = nb::ndarray<const T, Shape..., nb::c_contig, nb::device::cpu>;
using Nodes = Array<float, nb::shape<-1, -1, 2>>;
using Exact = Array<std::int32_t, nb::ndim<2>>;
using ExactCells = Array<float, nb::shape<-1, 16, 16, 2>>;
using Points = Array<double, nb::shape<-1, 2>>;
using Image = Array<float, nb::ndim<3>>;
using Plane = Array<std::uint32_t, nb::ndim<2>>;

template <typename A>
auto values_of(const A& array) {
    return std::span(array.data(), array.size());
}

/// Keeps the arrays alive that the map refers to.
struct BoundMap {
    Nodes nodes;
    Exact exact;
    ExactCells cells;
    dg::SourceMap map;

    BoundMap(Nodes n, Exact e, ExactCells c, int top)
        : nodes(std::move(n)), exact(std::move(e)), cells(std::move(c)) {
        map = {int(exact.shape(1)), int(exact.shape(0)), top,
               values_of(nodes),    values_of(exact),    values_of(cells)};
        map.check();
    }
};

auto remap(const Image& image, int first, int height,
           const std::vector<const BoundMap*>& maps, const std::vector<int>& map_of,
           std::pair<int, int> rows, std::string_view filter, bool antialias) {
    const auto [begin, end] = rows;
    std::vector<dg::SourceMap> given;
    for (const BoundMap* m : maps) {
        if (!m) throw dg::input_error("remap", "maps", "maps", "None");
        given.push_back(m->map);
    }
    const dg::RemapSource source{values_of(image), int(image.shape(1)), height,
                                 int(image.shape(2)), first};
    dg::RemapResult out;
    {
        dg::bind::Unlocked unlocked;
        const auto kind =
            filter == "linear" ? dg::RemapFilter::linear : dg::RemapFilter::cubic;
        out = dg::remap(source, given, map_of, begin, end, kind, antialias);
    }
    float* values = out.values.release();
    nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<float*>(p); });
    const std::size_t height_made = end - begin;
    nb::ndarray<nb::numpy, float> made(values, {height_made, image.shape(1), image.shape(2)},
                                       owner);
    return nb::make_tuple(std::move(made), out.undefined);
}

auto remap_nearest(const Plane& plane, int first, int height, const BoundMap& map,
                   int begin, int end) {
    std::vector<std::uint32_t> out;
    {
        dg::bind::Unlocked unlocked;
        out = dg::remap_nearest(values_of(plane), int(plane.shape(1)), height, first,
                                map.map, begin, end);
    }
    return dg::bind::to_numpy(std::move(out), {std::size_t(end - begin), plane.shape(1)});
}

}  // namespace

void bind_post_warp(nb::module_& m) {
    nb::class_<BoundMap>(m, "SourceMap")
        .def(nb::init<Nodes, Exact, ExactCells, int>(), "nodes"_a, "exact"_a,
             "exact_cells"_a, "top"_a,
             "How far away the light of each pixel lies, px: at nodes 16 px apart, (rows "
             "+ 3, columns + "
             "3, 2), and for cells in which exact (rows, columns) is not -1 at each "
             "pixel.")
        .def(
            "displacements",
            [](const BoundMap& m, int width, int begin, int end) {
                if (begin < m.map.top ||
                    end > m.map.top + m.map.rows * dg::SourceMap::kCell || begin >= end ||
                    width < 1 || width > m.map.columns * dg::SourceMap::kCell)
                    throw dg::input_error("map", "pixels", "pixels of the map", "pixels outside of it");
                return dg::bind::to_numpy(
                    m.map.displacements(width, begin, end),
                    {std::size_t(end - begin), std::size_t(width), 2});
            },
            "width"_a, "begin"_a, "end"_a,
            "Displacements of all pixels of some rows, (rows, width, 2), px.")
        .def(
            "displacements_at",
            [](const BoundMap& m, const Points& points) {
                std::vector<float> out;
                {
                    dg::bind::Unlocked unlocked;
                    out = m.map.displacements_at(values_of(points));
                }
                return dg::bind::to_numpy(std::move(out), {points.shape(0), 2});
            },
            "points"_a,
            "At points (N, 2), pixels by index, (N, 2), px; NaN where nodes do not tell.");
    m.def("remap", &remap, "image"_a, "first"_a, "height"_a, "maps"_a, "map_of"_a,
          "rows"_a, "filter"_a, "antialias"_a,
          "Rows [begin, end) of a picture seen through maps, and how many pixels no map "
          "defines. image: "
          "rows from `first` on of a picture of `height` rows, (rows, W, C).");
    m.def("remap_nearest", &remap_nearest, "plane"_a, "first"_a, "height"_a, "map"_a,
          "begin"_a, "end"_a,
          "The same for one channel of 32-bit words: the nearest pixel's.");
}
