// bind_optics.cpp -- prescriptions, first-order data, exact traces and the exact lens.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <ctime>

#include "bind/arrays.h"
#include "camera/exact.h"
#include "math/error.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Rows3d = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using ColumnF = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

dg::LensRay ray_at(const Rows3d& origins, const Rows3d& directions, std::size_t i) {
    const dg::Vec3d d{directions(i, 0), directions(i, 1), directions(i, 2)};
    return {{origins(i, 0), origins(i, 1), origins(i, 2)}, dg::normalize(d)};
}

/// Points (N, 3) on the plane image_z, and unit directions there; NaN where a ray is
/// stopped.
auto trace(const dg::Prescription& lens, const Rows3d& origins, const Rows3d& directions,
           const Column& wavelength_nm, double image_z, bool clip) {
    const std::size_t n = origins.shape(0);
    if (directions.shape(0) != n || wavelength_nm.shape(0) != n)
        throw dg::input_error(lens.name, "trace",
                              "as many directions and wavelengths as origins",
                              std::to_string(n) + " origins");
    const dg::Tracer tracer(lens);
    std::vector<double> points(3 * n), exits(3 * n);
    dg::LensIndices index{0, {}};
    for (std::size_t i = 0; i < n; ++i) {
        if (wavelength_nm(i) != index.wavelength_nm) index = tracer.at(wavelength_nm(i));
        const auto out =
            tracer.to_film(ray_at(origins, directions, i), index, {clip, nullptr, 0});
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const dg::Vec3d p =
            out ? dg::at_plane(out->ray, image_z) : dg::Vec3d{nan, nan, nan};
        const dg::Vec3d d = out ? out->ray.direction : dg::Vec3d{nan, nan, nan};
        for (int k = 0; k < 3; ++k) points[3 * i + k] = p[k], exits[3 * i + k] = d[k];
    }
    return nb::make_tuple(dg::bind::to_numpy(std::move(points), {n, 3}),
                          dg::bind::to_numpy(std::move(exits), {n, 3}));
}

/// Points (K, 3) on the surfaces along one ray, object side first; empty if it is
/// stopped.
auto path(const dg::Prescription& lens, const Rows3d& origin, const Rows3d& direction,
          double wavelength_nm, bool clip) {
    const dg::Tracer tracer(lens);
    std::vector<double> flat;
    for (const dg::Vec3d p : tracer.path_to_film(
             ray_at(origin, direction, 0), tracer.at(wavelength_nm), {clip, nullptr, 0}))
        flat.insert(flat.end(), {p.x, p.y, p.z});
    const std::size_t n = flat.size() / 3;
    return dg::bind::to_numpy(std::move(flat), {n, 3});
}

std::vector<dg::CameraSample> camera_samples(const dg::bind::Rows2f& film_mm,
                                             const dg::bind::Rows2f& u_lens,
                                             const ColumnF& wavelength_nm) {
    const std::size_t n = film_mm.shape(0);
    if (u_lens.shape(0) != n || wavelength_nm.shape(0) != n)
        throw dg::input_error("exact lens", "arrays", "equal lengths",
                              std::to_string(n) + " film points");
    std::vector<dg::CameraSample> samples(n);
    for (std::size_t i = 0; i < n; ++i)
        samples[i] = {{film_mm(i, 0), film_mm(i, 1)},
                      {u_lens(i, 0), u_lens(i, 1)},
                      0,
                      wavelength_nm(i)};
    return samples;
}

/// Rays in the camera frame (m): origins, directions, weights, weights before
/// transmittance.
auto generate(const dg::ExactLens& lens, const dg::bind::Rows2f& film_mm,
              const dg::bind::Rows2f& u_lens, const ColumnF& wavelength_nm) {
    const auto samples = camera_samples(film_mm, u_lens, wavelength_nm);
    const std::size_t n = samples.size();
    std::vector<dg::CameraRay> rays(n);
    lens.generate(samples, rays);
    std::vector<float> origins, directions, weights, aims;
    for (const dg::CameraRay& r : rays) {
        origins.insert(origins.end(), {r.ray.origin.x, r.ray.origin.y, r.ray.origin.z});
        directions.insert(directions.end(),
                          {r.ray.direction.x, r.ray.direction.y, r.ray.direction.z});
        weights.push_back(r.weight), aims.push_back(r.aim_weight);
    }
    return nb::make_tuple(dg::bind::to_numpy(std::move(origins), {n, 3}),
                          dg::bind::to_numpy(std::move(directions), {n, 3}),
                          dg::bind::to_numpy(std::move(weights), {n}),
                          dg::bind::to_numpy(std::move(aims), {n}));
}

/// CPU seconds of this thread: unlike the wall clock, the same on a busy machine.
double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Draws the samples `repeats` times in this thread: rays that passed, its CPU seconds.
std::pair<std::uint64_t, double> time_generate(const dg::ExactLens& lens,
                                               const dg::bind::Rows2f& film_mm,
                                               const dg::bind::Rows2f& u_lens,
                                               const ColumnF& wavelength_nm,
                                               int repeats) {
    const auto samples = camera_samples(film_mm, u_lens, wavelength_nm);
    std::vector<dg::CameraRay> rays(samples.size());
    std::uint64_t passed = 0;
    nb::gil_scoped_release release;
    const double start = thread_seconds();
    for (int i = 0; i < repeats; ++i) {
        lens.generate(samples, rays);
        for (const dg::CameraRay& r : rays) passed += r.weight > 0;
    }
    return {passed, thread_seconds() - start};
}

void bind_prescription(nb::module_& m) {
    using namespace dg;
    nb::class_<Glass>(m, "Glass")
        .def_static(
            "constant",
            [](double n) {
                return Glass{ConstantIndex{n}, ""};
            },
            "n"_a)
        .def_static(
            "abbe",
            [](double nd, double vd) {
                return Glass{AbbeGlass{nd, vd}, ""};
            },
            "nd"_a, "vd"_a)
        .def_static(
            "table",
            [](std::vector<double> nm, std::vector<double> n) {
                return Glass{TableGlass{std::move(nm), std::move(n)}, ""};
            },
            "wavelength_nm"_a, "n"_a)
        .def_static(
            "sellmeier",
            [](const std::vector<double>& b, const std::vector<double>& c) {
                if (b.size() != 3 || c.size() != 3)
                    throw Error("Sellmeier glass: wanted three b and three c");
                return Glass{SellmeierGlass{{b[0], b[1], b[2]}, {c[0], c[1], c[2]}}, ""};
            },
            "b"_a, "c_um2"_a)
        .def("index", &refractive_index, "wavelength_nm"_a);
    nb::class_<Surface>(m, "Surface")
        .def(
            "__init__",
            [](Surface* self, double curvature, double thickness, double semi_diameter,
               const Glass& glass, bool stop, const std::string& kind) {
                new (self)
                    Surface{curvature, thickness, semi_diameter, glass, stop, kind};
            },
            "curvature"_a, "thickness"_a, "semi_diameter"_a, "glass"_a, "stop"_a,
            "kind"_a);
    nb::class_<Prescription>(m, "Prescription")
        .def(
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
        .def("first_order", &first_order, "wavelength_nm"_a)
        .def(
            "film_position",
            [](const Prescription& lens, double distance_m, bool from_sensor) {
                return film_position(lens, first_order(lens), distance_m,
                                     from_sensor ? FocusFrom::sensor : FocusFrom::pupil);
            },
            "distance_m"_a, "from_sensor"_a)
        .def("trace", &trace, "origins"_a, "directions"_a, "wavelength_nm"_a, "image_z"_a,
             "clip"_a)
        .def("path", &path, "origin"_a, "direction"_a, "wavelength_nm"_a, "clip"_a);
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
        .def_ro("f_number", &FirstOrder::f_number);
}

}  // namespace

void bind_optics(nb::module_& m) {
    using namespace dg;
    bind_prescription(m);
    m.def("simd_target", &simd_target_name,
          "Instruction set of the lens kernels on this machine.");
    nb::class_<ExactLens>(m, "ExactLens")
        .def(
            "__init__",
            [](ExactLens* self, const Prescription& lens, double f_stop, const Iris& iris,
               double focus_distance_m, bool focus_from_sensor, double half_diagonal_mm,
               bool only_slope_boxes) {
                nb::gil_scoped_release release;   // states of a lens are set up side by side
                new (self) ExactLens(
                    lens, {f_stop, iris, focus_distance_m,
                           focus_from_sensor ? FocusFrom::sensor : FocusFrom::pupil,
                           half_diagonal_mm, only_slope_boxes});
            },
            "prescription"_a, "f_stop"_a, "iris"_a, "focus_distance_m"_a,
            "focus_from_sensor"_a, "half_diagonal_mm"_a, "only_slope_boxes"_a = false)
        .def_prop_ro("h0", &ExactLens::h0)
        .def_prop_ro("transmittance", &ExactLens::transmittance)
        .def_prop_ro("f_stop", &ExactLens::f_stop)
        .def_prop_ro("iris_radius_mm", &ExactLens::iris_radius_mm)
        .def_prop_ro("film_z_mm", &ExactLens::film_z_mm)
        .def_prop_ro("film_distance_mm", &ExactLens::film_distance_mm)
        .def_prop_ro("aim_degree",
                     [](const ExactLens& lens) { return lens.aim().tables.degree; })
        .def_prop_ro("aim_fallback_segments",
                     [](const ExactLens& lens) { return lens.aim().fallback_segments; })
        .def("first_order", &ExactLens::first_order)
        .def(
            "chief_direction",
            [](const ExactLens& lens, double x_mm, double y_mm) {
                const Vec3d d = lens.chief_direction({x_mm, y_mm});
                return nb::make_tuple(d.x, d.y, d.z);
            },
            "x_mm"_a, "y_mm"_a,
            "Unit view direction (camera frame) of a film point, mm upright.")
        .def("generate", &generate, "film_mm"_a, "u_lens"_a, "wavelength_nm"_a)
        .def("time_generate", &time_generate, "film_mm"_a, "u_lens"_a, "wavelength_nm"_a,
             "repeats"_a,
             "Draws the samples again and again in one thread: (rays that passed, "
             "seconds).");
}
