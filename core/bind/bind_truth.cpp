// bind_truth.cpp -- ground truth at a stated time, and motion in pixels.
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "bind/arrays.h"
#include "math/error.h"
#include "render/truth.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

/// One value per pixel of a member of Truth.
template <typename T, typename From, typename Of>
auto plane(const dg::Truth& truth, const std::vector<From>& values, const Of& of) {
    std::vector<T> out;
    out.reserve(values.size());
    for (const From& value : values) out.push_back(of(value));
    return dg::bind::to_numpy(std::move(out), {std::size_t(truth.region.height),
                                               std::size_t(truth.region.width)});
}

/// A plane by the name that it has in files.
nb::object plane_named(const dg::Truth& t, const std::string& name) {
    const auto same = [](auto value) { return value; };
    if (name == "depth.Z") return nb::cast(plane<float>(t, t.depth, same));
    if (name == "distance.Z") return nb::cast(plane<float>(t, t.distance, same));
    if (name == "object_id") return nb::cast(plane<std::uint32_t>(t, t.object_id, same));
    if (name == "material_id")
        return nb::cast(plane<std::uint32_t>(t, t.material_id, same));
    const int axis = name.empty() ? -1 : name.back() - 'X';
    if (axis >= 0 && axis < 3 && name.size() == 3 && name[1] == '.') {
        const auto component = [axis](dg::Vec3f v) { return v[axis]; };
        if (name[0] == 'P') return nb::cast(plane<float>(t, t.position, component));
        if (name[0] == 'N') return nb::cast(plane<float>(t, t.normal, component));
    }
    throw dg::input_error(
        "truth", "plane",
        "depth.Z, distance.Z, P.X/Y/Z, N.X/Y/Z, object_id or material_id", name);
}

auto places_of(const dg::Truth& truth, const dg::Scene& scene, const dg::Camera& camera,
               const dg::RenderSettings& settings) {
    std::vector<double> flat;
    {
        nb::gil_scoped_release release;
        for (const dg::Vec2d px : dg::places(truth, {scene, camera}, settings))
            flat.insert(flat.end(), {px.x, px.y});
    }
    return dg::bind::to_numpy(std::move(flat),
                              {std::size_t(truth.region.height),
                               std::size_t(truth.region.width), std::size_t(2)});
}

}  // namespace

void bind_truth(nb::module_& m) {
    using namespace dg;
    nb::class_<Truth>(m, "Truth")
        .def("plane", &plane_named, "name"_a, "Values (H, W) by the name of the channel.")
        .def("places", &places_of, "scene"_a, "camera"_a, "settings"_a,
             "Where what was seen lies in another frame, px (H, W, 2); NaN: it is not "
             "there.");
    m.def(
        "see",
        [](const Scene& scene, const Camera& camera, const RenderSettings& settings,
           std::tuple<int, int, int, int> crop) {
            const auto [x0, y0, x1, y1] = crop;
            nb::gil_scoped_release release;
            return see({scene, camera}, {x1 - x0, y1 - y0, x0, y0}, settings);
        },
        "scene"_a, "camera"_a, "settings"_a, "crop"_a,
        "Ground truth of the pixels (x0, y0, x1, y1), end exclusive.");
}
