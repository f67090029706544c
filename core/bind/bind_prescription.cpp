// bind_prescription.cpp -- surfaces, prescriptions, first-order data and exact
// traces of single rays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <map>
#include <optional>

#include "bind/arrays.h"
#include "bind/bind_first_order.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "optics/stray/ghost.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Rows3d = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

const double kNan = std::numeric_limits<double>::quiet_NaN();

dg::LensRay ray_at(const Rows3d& origins, const Rows3d& directions, std::size_t i) {
    const dg::Vec3d d{directions(i, 0), directions(i, 1), directions(i, 2)};
    return {{origins(i, 0), origins(i, 1), origins(i, 2)}, dg::normalize(d)};
}

std::size_t check_lengths(const dg::Prescription& lens, const Rows3d& origins,
                          const Rows3d& directions, const Column& wavelength_nm) {
    const std::size_t n = origins.shape(0);
    if (directions.shape(0) != n || wavelength_nm.shape(0) != n)
        throw dg::input_error(lens.name, "trace",
                              "as many directions and wavelengths as origins",
                              std::to_string(n) + " origins");
    return n;
}

/// Calls each(i, indices at the wavelength of ray i), on all cores.
template <typename Each>
void for_rays(const dg::Tracer& tracer, const Column& wavelength_nm, const Each& each) {
    constexpr std::size_t kGrain = 256;
    const dg::bind::Unlocked release;
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, wavelength_nm.shape(0), kGrain),
        [&](const auto& range) {
            std::optional<dg::LensIndices> index;  // empty: no ray yet
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                if (!index || wavelength_nm(i) != index->wavelength_nm)
                    index = tracer.at(wavelength_nm(i));
                each(i, *index);
            }
        });
}

/// Points (N, 3) on the plane image_z, and unit directions there; NaN for blocked rays.
auto trace(const dg::Prescription& lens, const Rows3d& origins, const Rows3d& directions,
           const Column& wavelength_nm, double image_z, bool clip) {
    const std::size_t n = check_lengths(lens, origins, directions, wavelength_nm);
    const dg::Tracer tracer(lens);
    std::vector<double> points(3 * n), exits(3 * n);
    for_rays(tracer, wavelength_nm, [&](std::size_t i, const dg::LensIndices& index) {
        const auto out =
            tracer.to_film(ray_at(origins, directions, i), index, {clip, nullptr, 0});
        const dg::Vec3d p =
            out ? dg::at_plane(out->ray, image_z) : dg::Vec3d{kNan, kNan, kNan};
        const dg::Vec3d d = out ? out->ray.direction : dg::Vec3d{kNan, kNan, kNan};
        for (int k = 0; k < 3; ++k) points[3 * i + k] = p[k], exits[3 * i + k] = d[k];
    });
    return nb::make_tuple(dg::bind::to_numpy(std::move(points), {n, 3}),
                          dg::bind::to_numpy(std::move(exits), {n, 3}));
}

/// Each ray at the last surface that it hit, and the surface that blocked it.
auto rays(const dg::Prescription& lens, const Rows3d& origins, const Rows3d& directions,
          const Column& wavelength_nm, bool clip, bool toward_film,
          std::optional<std::pair<int, int>> ghost) {
    const std::size_t n = check_lengths(lens, origins, directions, wavelength_nm);
    const dg::Tracer tracer(lens);
    const dg::LensPath way =
        ghost ? dg::ghost_path(tracer, ghost->first, ghost->second, toward_film)
              : dg::straight_path(int(lens.surfaces.size()), toward_film);
    std::vector<double> points(3 * n), exits(3 * n), iris(2 * n), path(n),
        transmittance(n);
    std::vector<std::int32_t> stopped(n);
    for_rays(tracer, wavelength_nm, [&](std::size_t i, const dg::LensIndices& index) {
        dg::TracedRay out{ray_at(origins, directions, i)};
        out.iris = {kNan, kNan};
        const int step = tracer.follow(out, way, index, {clip, nullptr, 0});
        stopped[i] = step < 0 ? -1 : way[step].surface;
        for (int k = 0; k < 3; ++k)
            points[3 * i + k] = out.ray.origin[k],
                           exits[3 * i + k] = out.ray.direction[k];
        iris[2 * i] = out.iris.x, iris[2 * i + 1] = out.iris.y;
        path[i] = out.optical_path;
        transmittance[i] = stopped[i] < 0 ? out.transmittance : 0;
    });
    using dg::bind::to_numpy;
    return nb::make_tuple(to_numpy(std::move(points), {n, 3}),
                          to_numpy(std::move(exits), {n, 3}),
                          to_numpy(std::move(iris), {n, 2}), to_numpy(std::move(path), {n}),
                          to_numpy(std::move(transmittance), {n}),
                          to_numpy(std::move(stopped), {n}));
}

/// Points (K, 3) on the surfaces along a ray, object side first; empty if it is blocked.
auto path(const dg::Prescription& lens, const Rows3d& origin, const Rows3d& direction,
          double wavelength_nm, bool clip) {
    if (origin.shape(0) != 1 || direction.shape(0) != 1)
        throw dg::input_error(lens.name, "path", "one ray",
                              std::to_string(origin.shape(0)) + " origins and " +
                                  std::to_string(direction.shape(0)) + " directions");
    const dg::Tracer tracer(lens);
    std::vector<double> flat;
    for (const dg::Vec3d p : tracer.path_to_film(
             ray_at(origin, direction, 0), tracer.at(wavelength_nm), {clip, nullptr, 0}))
        flat.insert(flat.end(), {p.x, p.y, p.z});
    const std::size_t n = flat.size() / 3;
    return dg::bind::to_numpy(std::move(flat), {n, 3});
}

auto jacobian(const dg::Prescription& lens, std::array<double, 3> origin,
              std::array<double, 3> direction, double wavelength_nm, double image_z) {
    const dg::Tracer tracer(lens);
    const dg::LensRay ray{
        {origin[0], origin[1], origin[2]},
        dg::normalize(dg::Vec3d{direction[0], direction[1], direction[2]})};
    std::vector<double> flat(16, kNan);
    if (const auto j = tracer.jacobian(ray, tracer.at(wavelength_nm), image_z))
        for (int i = 0; i < 16; ++i) flat[i] = (*j)[i / 4][i % 4];
    return dg::bind::to_numpy(std::move(flat), {4, 4});
}

void bind_surface(nb::module_& m) {
    using namespace dg;
    nb::class_<Surface>(m, "Surface")
        .def(
            "__init__",
            [](Surface* self, double curvature, double thickness, double semi_diameter,
               const Glass& glass, bool stop, const std::string& kind, double conic,
               const std::map<int, double>& asphere, double curvature_x, double conic_x,
               double inner_semi_diameter, double semi_diameter_after,
               std::array<double, 3> decenter, std::array<double, 3> tilt,
               const std::string& coating, std::tuple<double, double, unsigned> ripple) {
                Surface s{curvature, thickness, semi_diameter, glass, stop};
                s.conic = conic, s.curvature_x = curvature_x, s.conic_x = conic_x;
                for (const auto& [power, a] : asphere) s.asphere.push_back({power, a});
                s.inner_semi_diameter = inner_semi_diameter;
                s.semi_diameter_after = semi_diameter_after;
                s.decenter = {decenter[0], decenter[1], decenter[2]};
                s.tilt = {tilt[0], tilt[1], tilt[2]};
                s.coating = coating;
                s.ripple = {std::get<0>(ripple), std::get<1>(ripple), std::get<2>(ripple)};
                set_kind(s, kind);
                new (self) Surface(std::move(s));
            },
            "curvature"_a, "thickness"_a, "semi_diameter"_a, "glass"_a, "stop"_a,
            "kind"_a, nb::kw_only(), "conic"_a = 0.0,
            "asphere"_a = std::map<int, double>(), "curvature_x"_a = 0.0,
            "conic_x"_a = 0.0, "inner_semi_diameter"_a = 0.0,
            "semi_diameter_after"_a = 0.0, "decenter"_a = std::array<double, 3>{},
            "tilt"_a = std::array<double, 3>{}, "coating"_a = "",
            "ripple"_a = std::tuple<double, double, unsigned>{0, 0, 0},
            "asphere: {power of r: coefficient}; tilt in degrees; ripple: (nm RMS, period um, seed).");
}

}  // namespace

void bind_prescription(nb::module_& m) {
    using namespace dg;
    bind_surface(m);
    nb::class_<Prescription> lens(m, "Prescription");
    lens.def(
            "__init__",
            [](Prescription* self, const std::string& name,
               const std::vector<Surface>& surfaces, const Glass& object_medium,
               const std::string& coating, double nominal_f_number) {
                Prescription lens{name, object_medium, surfaces,
                                  coating_from_name(coating), nominal_f_number};
                validate(lens);
                new (self) Prescription(std::move(lens));
            },
            "name"_a, "surfaces"_a, "object_medium"_a, "coating"_a, "nominal_f_number"_a)
        .def("vertices", &Prescription::vertices, "z of the vertices, mm.")
        .def("trace", &trace, "origins"_a, "directions"_a, "wavelength_nm"_a, "image_z"_a,
             "clip"_a)
        .def("rays", &rays, "origins"_a, "directions"_a, "wavelength_nm"_a, "clip"_a,
             "toward_film"_a = true, "ghost"_a = nb::none(),
             "Each ray at the last surface that it met: (points (N, 3), directions (N, 3), "
             "iris (N, 2), optical path (N,), transmittance (N,), index of the surface "
             "that stopped it (N,), -1: none). ghost: two surfaces that reflect the light.")
        .def("jacobian", &jacobian, "origin"_a, "direction"_a, "wavelength_nm"_a,
             "image_z"_a,
             "d(x, y, n L, n M) on the plane image_z / at the ray's origin, (4, 4); NaN if "
             "the ray is stopped.")
        .def_prop_ro("is_axially_symmetric",
                     [](const Prescription& lens) { return is_axially_symmetric(lens); })
        .def("path", &path, "origin"_a, "direction"_a, "wavelength_nm"_a, "clip"_a);
    bind_first_order(m, lens);
}

