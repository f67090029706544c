// bind_optics.cpp -- the exact lens of a camera.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <limits>

#include "bind/arrays.h"
#include "bind/thread_seconds.h"
#include "camera/aim_state.h"
#include "camera/exact.h"
#include "camera/fit_state.h"
#include "math/error.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Pair = std::pair<double, double>;
using Picture = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using ColumnF = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

dg::Vec2d vec(Pair p) {
    return {p.first, p.second};
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

dg::ExactLensSettings settings(double f_stop, const dg::Iris& iris, double focus_distance_m,
                               bool focus_from_sensor, double half_diagonal_mm,
                               dg::PupilDraw draw, double film_z_mm, Pair tilt_deg,
                               Pair film_center_mm, Pair film_half_mm,
                               std::optional<int> fit_degree) {
    return {f_stop,
            iris,
            focus_distance_m,
            focus_from_sensor ? dg::FocusFrom::sensor : dg::FocusFrom::pupil,
            half_diagonal_mm,
            draw,
            std::isnan(film_z_mm) ? std::nullopt : std::optional(film_z_mm),
            vec(tilt_deg),
            vec(film_center_mm),
            vec(film_half_mm),
            fit_degree ? std::optional(dg::FittedGlass{*fit_degree}) : std::nullopt,
            ""};
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

/// The aim_state of the lens if its fit were another.
nb::bytes state_with_fit(const dg::ExactLens& lens, const dg::LensFit& fit) {
    const std::string bytes = lens.aim_state(), key = bytes.substr(0, 32);
    auto state = dg::aim_from_bytes(bytes, key);
    if (!state || state->fit.empty()) throw dg::Error("exact lens: wanted a lens with a fit");
    state->fit = dg::to_bytes(fit);
    const std::string other = dg::to_bytes(*state, key);
    return nb::bytes(other.data(), other.size());
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
    const double start = dg::bind::thread_seconds();
    for (int i = 0; i < repeats; ++i) {
        lens.generate(samples, rays);
        for (const dg::CameraRay& r : rays) passed += r.weight > 0;
    }
    return {passed, dg::bind::thread_seconds() - start};
}

}  // namespace

void bind_optics(nb::module_& m) {
    using namespace dg;
    m.def("simd_target", &simd_target_name,
          "Instruction set of the lens kernels on this machine.");
    nb::enum_<PupilDraw>(m, "PupilDraw")
        .value("aimed", PupilDraw::aimed)
        .value("slope_boxes", PupilDraw::slope_boxes)
        .value("rear_disc", PupilDraw::rear_disc);
    nb::class_<ExactLens>(m, "ExactLens")
        .def(
            "__init__",
            [](ExactLens* self, const Prescription& lens, double f_stop, const Iris& iris,
               double focus_distance_m, bool focus_from_sensor, double half_diagonal_mm,
               PupilDraw draw, double film_z_mm, Pair tilt_deg, Pair film_center_mm,
               Pair film_half_mm, std::optional<int> fit_degree,
               const std::optional<nb::bytes>& cache) {
                ExactLensSettings s =
                    settings(f_stop, iris, focus_distance_m, focus_from_sensor, half_diagonal_mm,
                             draw, film_z_mm, tilt_deg, film_center_mm, film_half_mm,
                             fit_degree);
                if (cache) s.cache.assign(cache->c_str(), cache->size());
                nb::gil_scoped_release release;   // states of a lens are set up side by side
                new (self) ExactLens(lens, s);
            },
            "prescription"_a, "f_stop"_a, "iris"_a, "focus_distance_m"_a,
            "focus_from_sensor"_a, "half_diagonal_mm"_a, "draw"_a = PupilDraw::aimed,
            nb::kw_only(), "film_z_mm"_a = kNan, "tilt_deg"_a = Pair{0, 0},
            "film_center_mm"_a = Pair{0, 0}, "film_half_mm"_a = Pair{0, 0},
            "fit_degree"_a = nb::none(), "cache"_a = nb::none(),
            "fit_degree: draw from polynomials of that degree instead of the surfaces. "
            "cache: aim_state of an earlier one; not used unless it fits.")
        .def_static(
            "aim_key",
            [](const Prescription& lens, double f_stop, const Iris& iris, double focus_distance_m,
               bool focus_from_sensor, double half_diagonal_mm, PupilDraw draw,
               double film_z_mm, Pair tilt_deg, Pair film_center_mm, Pair film_half_mm,
               std::optional<int> fit_degree) {
                return aim_key(lens, settings(f_stop, iris, focus_distance_m, focus_from_sensor,
                                              half_diagonal_mm, draw, film_z_mm,
                                              tilt_deg, film_center_mm, film_half_mm,
                                              fit_degree));
            },
            "prescription"_a, "f_stop"_a, "iris"_a, "focus_distance_m"_a,
            "focus_from_sensor"_a, "half_diagonal_mm"_a, "draw"_a = PupilDraw::aimed,
            nb::kw_only(), "film_z_mm"_a = kNan, "tilt_deg"_a = Pair{0, 0},
            "film_center_mm"_a = Pair{0, 0}, "film_half_mm"_a = Pair{0, 0},
            "fit_degree"_a = nb::none(),
            "Name of the aim_state that a lens with these arguments has.")
        .def_prop_ro("aim_state",
                     [](const ExactLens& lens) {
                         const std::string state = lens.aim_state();
                         return nb::bytes(state.data(), state.size());
                     },
                     "Results of the set-up, for `cache` of the same lens another time.")
        .def("state_with_fit", &state_with_fit, "fit"_a,
             "Its aim_state with another fit in place of its own, for comparisons.")
        .def("with_dirt",
             [](const ExactLens& lens, const std::optional<Picture>& front,
                const std::optional<Picture>& iris) {
                 const auto mask = [](const std::optional<Picture>& p) {
                     if (!p) return LensMask{};
                     return LensMask{int(p->shape(1)), int(p->shape(0)),
                                     std::vector<float>(p->data(), p->data() + p->size())};
                 };
                 return lens.with_dirt({mask(front), mask(iris)});
             },
             "front"_a.none(), "iris"_a.none(),
             "Dust and scratches: transmittances (H, W) over the clear front and the open iris.")
        .def("without_fit", &ExactLens::without_fit, "The same lens, traced surface by surface.")
        .def_prop_ro("fit", &ExactLens::fit, nb::rv_policy::reference_internal,
                     "Fit that rays are drawn from instead of the surfaces; None: they are traced.")
        .def_prop_ro("h0", &ExactLens::h0)
        .def_prop_ro("transmittance", &ExactLens::transmittance)
        .def_prop_ro("f_stop", &ExactLens::f_stop)
        .def_prop_ro("iris_radius_mm", &ExactLens::iris_radius_mm)
        .def_prop_ro("film_z_mm", &ExactLens::film_z_mm)
        .def_prop_ro("film_distance_mm", &ExactLens::film_distance_mm)
        .def_prop_ro("aim_degree",
                     [](const ExactLens& lens) {
                         const AimTables& t = lens.aim().tables;
                         return t.free.degree > 0 ? t.free.degree : t.degree;
                     })
        .def_prop_ro("aim_fallback_segments",
                     [](const ExactLens& lens) { return lens.aim().fallback_segments; })
        .def("first_order", &ExactLens::first_order)
        .def(
            "film_plane",
            [](const ExactLens& lens) {
                const FilmPlane p = lens.film_plane();
                const auto tuple = [](Vec3d v) { return nb::make_tuple(v.x, v.y, v.z); };
                return nb::make_tuple(tuple(p.center), tuple(p.x), tuple(p.y));
            },
            "Where the film lies in the lens's frame, mm: its (0, 0), and unit vectors along its "
            "coordinates, which are upside down: a point of the upright picture has the negative ones.")
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
