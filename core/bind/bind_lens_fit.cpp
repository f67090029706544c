// bind_lens_fit.cpp -- fitted lenses: their data, and evaluation of rays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "bind/arrays.h"
#include "bind/record.h"
#include "bind/thread_seconds.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "optics/first_order/paraxial.h"
#include "optics/expansion/lens_fit_simd.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Rows2d = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Rows3d = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Powers =
    nb::ndarray<const std::int32_t, nb::shape<-1, 5>, nb::c_contig, nb::device::cpu>;
using Table = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using dg::bind::def_pair;
using dg::bind::Pair;
using dg::bind::to_numpy;

const double kNan = std::numeric_limits<double>::quiet_NaN();

void bind_functions(nb::module_& m) {
    using namespace dg;
    nb::class_<FitFunctions>(m, "FitFunctions")
        .def(
            "__init__",
            [](FitFunctions* self, const Powers& powers, const Table& coefficients) {
                FitFunctions f{int(coefficients.shape(1)), {}, {}};
                if (powers.shape(0) != coefficients.shape(0))
                    throw input_error("lens fit", "coefficients",
                                      "a row for each monomial",
                                      std::to_string(coefficients.shape(0)));
                for (std::size_t i = 0; i < powers.shape(0); ++i) {
                    FitTerm t{};
                    for (int k = 0; k < 5; ++k) t[k] = powers(i, k);
                    f.terms.push_back(t);
                }
                f.coefficients.assign(coefficients.data(),
                                      coefficients.data() + coefficients.size());
                new (self) FitFunctions(std::move(f));
            },
            "powers"_a, "coefficients"_a)
        .def_prop_ro(
            "powers",
            [](const FitFunctions& f) {
                std::vector<std::int32_t> flat;
                for (const FitTerm& t : f.terms)
                    flat.insert(flat.end(), t.begin(), t.end());
                return to_numpy(std::move(flat), {f.terms.size(), 5});
            },
            nb::rv_policy::automatic)
        .def_prop_ro(
            "coefficients",
            [](const FitFunctions& f) {
                return to_numpy(std::vector<double>(f.coefficients),
                                {f.terms.size(), std::size_t(f.count)});
            },
            nb::rv_policy::automatic);
}

void bind_parts(nb::module_& m) {
    using namespace dg;
    nb::class_<FitBlock>(m, "FitBlock")
        .def(nb::init<>())
        .def_rw("x", &FitBlock::x)
        .def_rw("y", &FitBlock::y);
    nb::class_<FitSegment>(m, "FitSegment")
        .def(nb::init<>())
        .def_rw("u_low", &FitSegment::u_low)
        .def_rw("u_high", &FitSegment::u_high)
        .def_rw("bend", &FitSegment::bend)
        .def_rw("direction", &FitSegment::direction)
        .def_rw("points", &FitSegment::points)
        .def_rw("light", &FitSegment::light);
    nb::class_<FitPupil> pupil(m, "FitPupil");
    pupil.def(nb::init<>());
    def_pair(pupil, "by_film", &FitPupil::by_film);
    def_pair(pupil, "by_slope", &FitPupil::by_slope);
    def_pair(pupil, "shift", &FitPupil::shift);
    nb::class_<FitInverse>(m, "FitInverse")
        .def(nb::init<>())
        .def_rw("direction", &FitInverse::direction)
        .def_rw("pupil", &FitInverse::pupil)
        .def_rw("rays", &FitInverse::rays);
    nb::class_<FitMount>(m, "FitMount")
        .def(nb::init<>())
        .def_rw("surface", &FitMount::surface)
        .def_rw("radius", &FitMount::radius)
        .def_rw("inner", &FitMount::inner);
}

void bind_error(nb::module_& m) {
    using namespace dg;
    nb::class_<FitDeviation>(m, "FitDeviation")
        .def(nb::init<>())
        .def_rw("rms", &FitDeviation::rms)
        .def_rw("max", &FitDeviation::max);
    nb::class_<FitErrorZone>(m, "FitErrorZone")
        .def(nb::init<>())
        .def_rw("low", &FitErrorZone::low)
        .def_rw("high", &FitErrorZone::high)
        .def_rw("rays", &FitErrorZone::rays)
        .def_rw("direction", &FitErrorZone::direction)
        .def_rw("film", &FitErrorZone::film)
        .def_rw("iris", &FitErrorZone::iris)
        .def_rw("mount", &FitErrorZone::mount)
        .def_rw("transmittance", &FitErrorZone::transmittance)
        .def_rw("lost", &FitErrorZone::lost)
        .def_rw("leaked", &FitErrorZone::leaked);
    nb::class_<FitError>(m, "FitError")
        .def(nb::init<>())
        .def_rw("all", &FitError::all)
        .def_rw("zones", &FitError::zones);
}

/// A validated copy of the fit, as Python may have changed its parts.
const dg::LensFit& checked(const dg::LensFit& fit) {
    check_lens_fit(fit);
    return fit;
}

std::size_t same_count(std::size_t n, std::size_t other, const char* what) {
    if (other != n)
        throw dg::input_error("lens fit", what, std::to_string(n), std::to_string(other));
    return n;
}

std::size_t equal_lengths(const Rows2d& film, const Rows2d& slopes, const Column& nm) {
    const std::size_t n = film.shape(0);
    if (slopes.shape(0) != n || nm.shape(0) != n)
        throw dg::input_error("lens fit", "arrays",
                              "as many slopes and wavelengths as film points",
                              std::to_string(n) + " film points");
    return n;
}

/// Directions (rad) and offsets, iris points, mounts (N, M, 2), transmittances, validity, and origins and unit
/// directions of the scene rays.
auto evaluate(const dg::LensFit& fit, const Rows2d& film, const Rows2d& slopes,
              const Column& nm) {
    const std::size_t n = equal_lengths(film, slopes, nm);
    const std::size_t mounts = checked(fit).mounts.size();
    std::vector<double> direction, offset, iris, mount, light, origin, unit;
    std::vector<std::uint8_t> within;
    for (std::size_t i = 0; i < n; ++i) {
        const dg::FitValue v =
            fit.evaluate({{film(i, 0), film(i, 1)}, {slopes(i, 0), slopes(i, 1)}, nm(i)});
        const dg::LensRay ray = fit.scene_ray(v.direction, v.offset);
        const auto add = [](std::vector<double>& to, dg::Vec2d p) {
            to.insert(to.end(), {p.x, p.y});
        };
        add(direction, v.direction), add(offset, v.offset), add(iris, v.iris);
        for (const dg::Vec2d p : v.mounts) add(mount, p);
        for (int k = 0; k < 3; ++k)
            origin.push_back(ray.origin[k]), unit.push_back(ray.direction[k]);
        light.push_back(v.transmittance), within.push_back(v.within);
    }
    return nb::make_tuple(
        to_numpy(std::move(direction), {n, 2}), to_numpy(std::move(offset), {n, 2}),
        to_numpy(std::move(iris), {n, 2}), to_numpy(std::move(mount), {n, mounts, 2}),
        to_numpy(std::move(light), {n}), to_numpy(std::move(within), {n}),
        to_numpy(std::move(origin), {n, 3}), to_numpy(std::move(unit), {n, 3}));
}

/// Film points and slopes of scene rays (lens frame, mm); NaN where the iteration leaves the domain of the fit.
auto to_film(const dg::LensFit& fit, const Rows3d& origins, const Rows3d& directions,
             const Column& nm) {
    const std::size_t n = same_count(origins.shape(0), directions.shape(0), "directions");
    same_count(n, nm.shape(0), "wavelengths");
    checked(fit);
    std::vector<double> film, slope;
    for (std::size_t i = 0; i < n; ++i) {
        const dg::LensRay ray{{origins(i, 0), origins(i, 1), origins(i, 2)},
                              {directions(i, 0), directions(i, 1), directions(i, 2)}};
        const auto found = fit.to_film(ray, nm(i));
        const dg::FitRay r =
            found ? *found : dg::FitRay{{kNan, kNan}, {kNan, kNan}, nm(i)};
        film.insert(film.end(), {r.film.x, r.film.y}),
            slope.insert(slope.end(), {r.slope.x, r.slope.y});
    }
    return nb::make_tuple(to_numpy(std::move(film), {n, 2}),
                          to_numpy(std::move(slope), {n, 2}));
}

dg::LensFit fit(const dg::Prescription& lens, double f_stop, dg::LensFitRequest request) {
    const dg::FirstOrder order = dg::first_order(lens);
    request.iris_radius =
        dg::iris_radius(lens, order, f_stop == 0 ? order.f_number : f_stop);
    const dg::bind::Unlocked release;
    return make_lens_fit(dg::Tracer(lens), request);
}

void bind_request(nb::module_& m) {
    using dg::LensFitRequest;
    nb::class_<LensFitRequest> c(m, "LensFitRequest", "The part of the film that a fit is for, and how fine it is.");
    dg::bind::def_fields_init(c, "Fields by name.");
    c.def_rw("film_z_mm", &LensFitRequest::film_z, "Place of the film in the lens frame.")
        .def_rw("film_radius_mm", &LensFitRequest::film_radius, "Its farthest point.")
        .def_prop_rw(
            "film_half_mm", [](const LensFitRequest& r) { return dg::bind::pair(r.film.half); },
            [](LensFitRequest& r, Pair half) { r.film.half = dg::bind::vec(half); },
            "Half its width and height; (0, 0): all within the radius.")
        .def_rw("iris", &LensFitRequest::iris)
        .def_rw("degree", &LensFitRequest::degree, "Odd, 1 to 13.")
        .def_rw("segments", &LensFitRequest::segments, "Parts of the film's radius.")
        .def_rw("terms", &LensFitRequest::terms, "Terms of each vector; 0: all.");
}

/// Directions (rad) and offsets of scene rays.
auto describe(const dg::LensFit& fit, const Rows3d& origins, const Rows3d& directions) {
    const std::size_t n = same_count(origins.shape(0), directions.shape(0), "directions");
    std::vector<double> angles, offsets;
    for (std::size_t i = 0; i < n; ++i) {
        const dg::FitDirection d =
            dg::describe_ray({{origins(i, 0), origins(i, 1), origins(i, 2)},
                              {directions(i, 0), directions(i, 1), directions(i, 2)}},
                             fit.entrance_pupil_z);
        angles.insert(angles.end(), {d.direction.x, d.direction.y});
        offsets.insert(offsets.end(), {d.offset.x, d.offset.y});
    }
    return nb::make_tuple(to_numpy(std::move(angles), {n, 2}),
                          to_numpy(std::move(offsets), {n, 2}));
}

dg::LensFit refitted(const dg::LensFit& fit, const Rows2d& film, const Rows2d& slopes,
                     const Column& nm, const Rows2d& angles, const Rows2d& offsets) {
    const std::size_t n = equal_lengths(film, slopes, nm);
    if (angles.shape(0) != n || offsets.shape(0) != n)
        throw dg::input_error("lens fit", "arrays",
                              "as many angles and offsets as film points",
                              std::to_string(n) + " film points");
    std::vector<dg::FitRay> rays;
    std::vector<dg::FitDirection> scene;
    for (std::size_t i = 0; i < n; ++i) {
        rays.push_back({{film(i, 0), film(i, 1)}, {slopes(i, 0), slopes(i, 1)}, nm(i)});
        scene.push_back({{angles(i, 0), angles(i, 1)}, {offsets(i, 0), offsets(i, 1)}});
    }
    return dg::refit_rays(checked(fit), rays, scene);
}

/// CPU seconds of this thread per ray for the kernels in both directions, over the given film rays.
Pair seconds_a_ray(const dg::LensFit& fit, const Rows2d& film, const Rows2d& slopes,
                   const Column& nm, int repeats) {
    const std::size_t n = equal_lengths(film, slopes, nm);
    if (n == 0) throw dg::input_error("lens fit", "film points", "at least one", "none");
    checked(fit);
    dg::IrisTables iris;
    iris.radius = float(fit.iris_radius);
    const dg::FitTables tables = make_fit_tables(fit, iris);
    std::vector<dg::FilmRays> batches((n + dg::kLensBatch - 1) / dg::kLensBatch);
    for (std::size_t i = 0; i < batches.size() * dg::kLensBatch; ++i) {
        dg::FilmRays& b = batches[i / dg::kLensBatch];
        const std::size_t k = i % dg::kLensBatch, from = i % n;
        b.x[k] = float(film(from, 0)), b.y[k] = float(film(from, 1));
        b.mx[k] = float(slopes(from, 0)), b.my[k] = float(slopes(from, 1)),
        b.nm[k] = float(nm(from));
    }
    const auto scene = std::make_unique<dg::SceneRays>();
    const auto back = std::make_unique<dg::FilmRays>();
    const dg::bind::Unlocked release;
    const auto time = [&](auto each) {
        const double start = dg::bind::thread_seconds();
        for (int i = 0; i < repeats; ++i)
            for (const dg::FilmRays& b : batches) each(b);
        return (dg::bind::thread_seconds() - start) /
               (double(repeats) * double(batches.size()) * dg::kLensBatch);
    };
    const double out = time(
        [&](const dg::FilmRays& b) { fit_to_scene(tables, b, *scene, dg::kLensBatch); });
    std::copy(batches[0].nm, batches[0].nm + dg::kLensBatch, back->nm);
    const double in = time(
        [&](const dg::FilmRays&) { fit_to_film(tables, *scene, *back, dg::kLensBatch); });
    return {out, in};
}

/// Parts of a fit that files store.
void def_data(nb::class_<dg::LensFit>& c) {
    using namespace dg;
    c.def_rw("lens", &LensFit::lens)
        .def_rw("degree", &LensFit::degree)
        .def_prop_rw(
            "symmetry",
            [](const LensFit& f) {
                return std::tuple{f.symmetry.axial, f.symmetry.mirror_x,
                                  f.symmetry.mirror_y};
            },
            [](LensFit& f, std::tuple<bool, bool, bool> s) {
                f.symmetry = {std::get<0>(s), std::get<1>(s), std::get<2>(s)};
            })
        .def_prop_ro("wavelength_scale",
                     [](const LensFit& f) {
                         return Pair{f.scale.offset, f.scale.scale};
                     })
        .def_prop_rw(
            "film_plane",
            [](const LensFit& f) {
                const auto flat = [](Vec3d v) { return std::array{v.x, v.y, v.z}; };
                return std::vector{flat(f.film.center), flat(f.film.x), flat(f.film.y)};
            },
            [](LensFit& f, const std::vector<std::array<double, 3>>& p) {
                const auto vec3 = [](std::array<double, 3> v) {
                    return Vec3d{v[0], v[1], v[2]};
                };
                f.film = {vec3(p.at(0)), vec3(p.at(1)), vec3(p.at(2))};
            })
        .def_rw("pupil", &LensFit::pupil)
        .def_rw("entrance_pupil_z", &LensFit::entrance_pupil_z)
        .def_rw("front_z", &LensFit::front_z)
        .def_rw("front_curvature", &LensFit::front_curvature)
        .def_rw("iris_radius", &LensFit::iris_radius)
        .def_rw("iris_outer", &LensFit::iris_outer)
        .def_rw("mounts", &LensFit::mounts)
        .def_rw("segments", &LensFit::segments)
        .def_rw("inverse", &LensFit::inverse)
        .def_rw("error", &LensFit::error);
    def_pair(c, "film_center", &LensFit::film_center);
    def_pair(c, "film_half", &LensFit::film_half);
}

}  // namespace

void bind_lens_fit(nb::module_& m) {
    using namespace dg;
    bind_functions(m), bind_parts(m), bind_error(m), bind_request(m);
    nb::class_<LensFit> c(m, "LensFit");
    c.def(nb::init<>())
        .def_static("fit", &fit, "prescription"_a, "f_stop"_a, "request"_a,
                    "f_stop 0: as wide as the lens opens.")
        .def("describe", &describe, "origins"_a, "directions"_a)
        .def("refitted", &refitted, "film_mm"_a, "slopes"_a, "wavelength_nm"_a,
             "angles"_a, "offsets"_a)
        .def("seconds_a_ray", &seconds_a_ray, "film_mm"_a, "slopes"_a, "wavelength_nm"_a,
             "repeats"_a, "CPU seconds of the kernels: film to scene, scene to film.")
        .def("check", &check_lens_fit, "Error if its parts do not fit together.")
        .def("evaluate", &evaluate, "film_mm"_a, "slopes"_a, "wavelength_nm"_a)
        .def("to_film", &to_film, "origins"_a, "directions"_a, "wavelength_nm"_a);
    def_data(c);
}
