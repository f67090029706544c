// bind_ghosts.cpp -- the ghosts of a lens on the bench.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "camera/camera.h"
#include "math/error.h"
#include "optics/stray/ghost_spots.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Pair = std::pair<double, double>;

auto spots(const dg::GhostLens& lens, double angle, Pair film_half, const std::vector<double>& nm,
           const std::vector<double>& weight, int rays, bool points) {
    std::vector<dg::GhostSpot> found;
    {
        dg::bind::Unlocked release;
        found = ghost_spots(lens, {angle, {film_half.first, film_half.second}, rays, nm, weight}, points);
    }
    nb::list out;
    for (const dg::GhostSpot& s : found) {
        std::vector<float> flat;
        for (const auto& p : s.points) flat.insert(flat.end(), p.begin(), p.end());
        const std::size_t n = s.points.size();
        out.append(nb::make_tuple(s.mirrors, s.light, s.all, nb::make_tuple(s.center.x, s.center.y), s.radius,
                                  dg::bind::to_numpy(std::move(flat), {n, 3})));
    }
    return out;
}

/// Points (K, 3) where a ray hits the surfaces of a ghost and the film; empty if it is blocked.
auto path(const dg::GhostLens& lens, const dg::Mirrors& mirrors, const std::array<double, 3>& origin,
          const std::array<double, 3>& direction, double nm) {
    const int count = int(lens.tracer().vertices().size());
    for (const int mirror : mirrors)
        if (mirror < 0 || mirror >= count)
            throw dg::input_error("ghost", "mirrors", "surfaces of 0 .. " + std::to_string(count - 1),
                                  std::to_string(mirror));
    dg::TracedRay ray{{{origin[0], origin[1], origin[2]},
                       dg::normalize(dg::Vec3d{direction[0], direction[1], direction[2]})}};
    const dg::LensIndices n = lens.tracer().at(nm);
    std::vector<double> flat;
    dg::TracedRay whole = ray;
    if (lens.tracer().follow(whole, lens.path(mirrors), n, lens.clip()) >= 0)
        return dg::bind::to_numpy(std::move(flat), {std::size_t(0), std::size_t(3)});
    for (const dg::PathStep& step : lens.path(mirrors)) {
        lens.tracer().follow(ray, dg::LensPath{step}, n, lens.clip());
        flat.insert(flat.end(), {ray.ray.origin.x, ray.ray.origin.y, ray.ray.origin.z});
    }
    const dg::Vec3d end = dg::at_plane(ray.ray, lens.film().center.z);
    flat.insert(flat.end(), {end.x, end.y, end.z});
    const std::size_t points = flat.size() / 3;
    return dg::bind::to_numpy(std::move(flat), {points, std::size_t(3)});
}

dg::SensorStack stack(double thickness, double index, double gap, double reflectance) {
    return {.cover_thickness = thickness, .cover_index = index, .cover_gap = gap, .reflectance = reflectance};
}

}  // namespace

void bind_ghosts(nb::module_& m) {
    using namespace dg;
    nb::class_<SensorStack>(m, "SensorStack")
        .def("__init__",
             [](SensorStack* self, double thickness, double index, double gap, double reflectance) {
                 const SensorStack made = stack(thickness, index, gap, reflectance);
                 check_stack(made);
                 new (self) SensorStack(made);
             },
             "cover_mm"_a = 0.0, "cover_index"_a = 1.5168, "gap_mm"_a = 1.0, "reflectance"_a = 0.0,
             "Glass before the sensor (mm; 0: none), the air behind it, and the sensor as a mirror.");
    nb::class_<GhostLens>(m, "GhostLens")
        .def("__init__",
             [](GhostLens* self, const Prescription& lens, double film_z_mm, const Iris& iris,
                double iris_radius_mm, const SensorStack& stack, double half_diagonal_mm) {
                 new (self) GhostLens(lens, {{0, 0, film_z_mm}}, iris, iris_radius_mm, stack, half_diagonal_mm);
             },
             "prescription"_a, "film_z_mm"_a, "iris"_a, "iris_radius_mm"_a, "stack"_a, "half_diagonal_mm"_a)
        .def_prop_ro("reflecting", &GhostLens::reflecting, "Indices of the surfaces that reflect.")
        .def_prop_ro("film_z_mm", [](const GhostLens& g) { return g.film().center.z; })
        .def_prop_ro("vertices", [](const GhostLens& g) { return g.tracer().vertices(); })
        .def("spots", &spots, "angle_rad"_a, "film_half_mm"_a, "nm"_a, "weight"_a, "rays"_a = 4096,
             "points"_a = false,
             "Brightest first: (mirrors, light on the film over that of the picture of the same source "
             "straight ahead, the same wherever it lands, centre (mm), RMS radius (mm), points (N, 3)).")
        .def("path", &path, "mirrors"_a, "origin"_a, "direction"_a, "wavelength_nm"_a,
             "Points (K, 3) where a ray meets surfaces and film; empty: it is stopped.");
}
