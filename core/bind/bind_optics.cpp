// bind_optics.cpp -- the exact lens of a camera.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "bind/arrays.h"
#include "bind/record.h"
#include "bind/thread_seconds.h"
#include "bind/unlocked.h"
#include "camera/exact.h"
#include "math/error.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Picture = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using ColumnF = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

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

/// Rays in the camera frame (m): origins, directions, weights, weights without transmittance.
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

/// Traces the samples `repeats` times in this thread; returns the number of rays that passed, and CPU seconds.
std::pair<std::uint64_t, double> time_generate(const dg::ExactLens& lens,
                                               const dg::bind::Rows2f& film_mm,
                                               const dg::bind::Rows2f& u_lens,
                                               const ColumnF& wavelength_nm,
                                               int repeats) {
    const auto samples = camera_samples(film_mm, u_lens, wavelength_nm);
    std::vector<dg::CameraRay> rays(samples.size());
    std::uint64_t passed = 0;
    dg::bind::Unlocked release;
    const double start = dg::bind::thread_seconds();
    for (int i = 0; i < repeats; ++i) {
        lens.generate(samples, rays);
        for (const dg::CameraRay& r : rays) passed += r.weight > 0;
    }
    return {passed, dg::bind::thread_seconds() - start};
}

void bind_settings(nb::module_& m) {
    using S = dg::ExactLensSettings;
    nb::class_<S> c(m, "ExactLensSettings", "An exact lens at one focus and f-stop, and the film that it covers.");
    dg::bind::def_fields_init(c, "Fields by name.");
    c.def_rw("f_stop", &S::f_stop, "0: as wide as the lens opens.")
        .def_rw("iris", &S::iris)
        .def_rw("focus_distance_m", &S::focus_distance_m, "Not used if film_z_mm is given.")
        .def_prop_rw(
            "focus_from_sensor", [](const S& s) { return s.focus_from == dg::FocusFrom::sensor; },
            [](S& s, bool sensor) { s.focus_from = sensor ? dg::FocusFrom::sensor : dg::FocusFrom::pupil; },
            "Whether the distance is from the film, else from the entrance pupil.")
        .def_rw("half_diagonal_mm", &S::half_diagonal_mm, "Farthest film point, shift included.")
        .def_rw("draw", &S::draw)
        .def_rw("film_z_mm", &S::film_z, nb::for_setter(nb::arg("value").none()),
                "Place of the film in the lens frame; None: solved for the distance.")
        .def_prop_rw(
            "fit_degree",
            [](const S& s) { return s.fitted ? std::optional(s.fitted->degree) : std::nullopt; },
            [](S& s, std::optional<int> degree) {
                s.fitted = degree ? std::optional(dg::FittedGlass{*degree}) : std::nullopt;
            },
            nb::for_setter(nb::arg("value").none()),
            "Draw from polynomials of that degree; None: from the surfaces.");
    dg::bind::def_pair(c, "tilt_deg", &S::tilt_deg, "Turn about x, then y of the camera's frame.");
    dg::bind::def_pair(c, "film_center_mm", &S::film_center_mm, "Middle of the part that is used, upright.");
    dg::bind::def_pair(c, "film_half_mm", &S::film_half_mm, "Half its size; (0, 0): all within half_diagonal_mm.");
}

/// Constructor of a lens, and results of its set-up.
void def_set_up(nb::class_<dg::ExactLens>& c) {
    using namespace dg;
    c.def(
         "__init__",
         [](ExactLens* self, const Prescription& lens, const ExactLensSettings& settings) {
             dg::bind::Unlocked release;   // states of a lens are set up in parallel
             new (self) ExactLens(lens, settings);
         },
         "prescription"_a, "settings"_a);
}

/// Copies of the lens with a changed option.
void def_variants(nb::class_<dg::ExactLens>& c) {
    using namespace dg;
    c.def("with_dirt",
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
        .def("with_fit", &ExactLens::with_fit, "fit"_a, "The same lens, drawn from this fit.")
        .def("without_fit", &ExactLens::without_fit, "The same lens, traced surface by surface.")
        .def_prop_ro("fit", &ExactLens::fit, nb::rv_policy::reference_internal,
                     "Fit that rays are drawn from instead of the surfaces; None: they are traced.");
}

void def_numbers(nb::class_<dg::ExactLens>& c) {
    using namespace dg;
    c.def_prop_ro("h0", &ExactLens::h0)
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
                     [](const ExactLens& lens) { return lens.aim().fallback_segments; });
}

void def_rays(nb::class_<dg::ExactLens>& c) {
    using namespace dg;
    c.def("first_order", &ExactLens::first_order)
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

}  // namespace

void bind_optics(nb::module_& m) {
    using namespace dg;
    m.def("simd_target", &simd_target_name,
          "Instruction set of the lens kernels on this machine.");
    nb::enum_<PupilDraw>(m, "PupilDraw")
        .value("aimed", PupilDraw::aimed)
        .value("slope_boxes", PupilDraw::slope_boxes)
        .value("rear_disc", PupilDraw::rear_disc);
    bind_settings(m);
    nb::class_<ExactLens> c(m, "ExactLens");
    def_set_up(c);
    def_variants(c);
    def_numbers(c);
    def_rays(c);
}
