// bind_camera.cpp -- bindings of cameras.
#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "camera/camera.h"
#include "camera/inverse/chief.h"
#include "math/error.h"
#include "render/truth/ray_map.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Picture = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// World rays (m) for given film points and lens samples, for tests and maps.
auto rays(const dg::Camera& camera, const dg::bind::Rows2f& film_mm, const dg::bind::Rows2f& u_lens,
          const nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>& wavelength_nm) {
    const std::size_t n = film_mm.shape(0);
    if (u_lens.shape(0) != n || wavelength_nm.shape(0) != n)
        throw dg::input_error("camera rays", "arrays", "equal lengths", std::to_string(n) + " film points");
    std::vector<dg::CameraSample> samples(n);
    for (std::size_t i = 0; i < n; ++i)
        samples[i] = {{film_mm(i, 0), film_mm(i, 1)}, {u_lens(i, 0), u_lens(i, 1)}, 0, wavelength_nm(i)};
    std::vector<dg::CameraRay> out(n);
    {
        dg::bind::Unlocked release;
        generate_rays(camera, samples, out);
    }
    std::vector<float> origins, directions, weights;
    for (const dg::CameraRay& r : out) {
        const dg::Ray world = r.weight > 0 ? to_world(camera, r.ray) : dg::Ray{};
        for (int k = 0; k < 3; ++k) origins.push_back(world.origin[k]);
        for (int k = 0; k < 3; ++k) directions.push_back(world.direction[k]);
        weights.push_back(r.weight);
    }
    return std::tuple{dg::bind::to_numpy(std::move(origins), {n, std::size_t(3)}),
                      dg::bind::to_numpy(std::move(directions), {n, std::size_t(3)}),
                      dg::bind::to_numpy(std::move(weights), {n})};
}

using Rows3d = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Rows2d = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

/// Chief rays of film points, in the camera frame.
auto chief_rays(const dg::ChiefRays& chief, const Rows2d& film_mm) {
    const std::size_t n = film_mm.shape(0);
    std::vector<double> origins, directions;
    for (std::size_t i = 0; i < n; ++i) {
        const dg::ChiefRay ray = chief.at({film_mm(i, 0), film_mm(i, 1)});
        for (int k = 0; k < 3; ++k) origins.push_back(ray.origin[k]), directions.push_back(ray.direction[k]);
    }
    return std::tuple{dg::bind::to_numpy(std::move(origins), {n, std::size_t(3)}),
                      dg::bind::to_numpy(std::move(directions), {n, std::size_t(3)})};
}

/// Film points of points or directions in the camera frame; NaN where there is none.
auto film_points(const dg::ChiefRays& chief, const Rows3d& points, bool at_infinity) {
    const std::size_t n = points.shape(0);
    std::vector<double> film(2 * n, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < n; ++i) {
        const auto mm =
            chief.film_point({points(i, 0), points(i, 1), points(i, 2)}, at_infinity ? 0 : 1);
        if (mm) film[2 * i] = mm->x, film[2 * i + 1] = mm->y;
    }
    return dg::bind::to_numpy(std::move(film), {n, std::size_t(2)});
}

auto seen(const dg::ChiefRays& chief, const dg::Camera& camera, const Rows2d& film_mm) {
    const std::size_t n = film_mm.shape(0);
    auto flags = std::make_unique<bool[]>(n);
    for (std::size_t i = 0; i < n; ++i) flags[i] = sees(camera, chief, {film_mm(i, 0), film_mm(i, 1)}, 0);
    bool* const data = flags.release();
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<bool*>(p); });
    return nb::ndarray<nb::numpy, bool>(data, {n}, owner);
}

using Column = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

std::vector<float> rising(const Column& times, std::size_t wanted, const char* what) {
    if (times.shape(0) != wanted || wanted == 0)
        throw dg::input_error("camera", what, "one for each time, at least one",
                              std::to_string(wanted) + " and " + std::to_string(times.shape(0)));
    if (!std::is_sorted(times.data(), times.data() + wanted))
        throw dg::Error(std::string("camera: ") + what + ": times must not decrease");
    return {times.data(), times.data() + wanted};
}

void change_lens(dg::Camera& camera, const Column& times, const std::vector<const dg::Camera*>& cameras) {
    dg::LensMotion motion{rising(times, cameras.size(), "lenses"), {}};
    for (const dg::Camera* at : cameras) {
        if (!at || at->lens.index() != camera.lens.index())
            throw dg::Error("camera: lenses: all must be of the same kind");
        motion.lenses.push_back(std::visit(
            [&](const auto& kind) -> dg::LensKind {
                using Kind = std::decay_t<decltype(kind)>;
                if constexpr (requires { kind.in_the_body_of(kind); })
                    return kind.in_the_body_of(std::get<Kind>(camera.lens));
                else
                    return kind;
            },
            at->lens));
    }
    camera.lens_motion = std::move(motion);
}

void change_setting(dg::Camera& camera, const Column& times, const Column& openings,
                    const dg::bind::Rows2f& shifts) {
    const std::size_t n = openings.shape(0);
    if (shifts.shape(0) != n) throw dg::Error("camera: setting: wanted a shift for each opening");
    dg::Keyed<dg::LensSetting> setting{rising(times, n, "setting"), {}};
    for (std::size_t i = 0; i < n; ++i)
        setting.values.push_back({openings(i), {shifts(i, 0), shifts(i, 1)}});
    camera.setting = std::move(setting);
}

dg::NumberGroups lens_numbers(const dg::Camera& camera) {
    return std::visit(
        []<typename L>(const L& lens) -> dg::NumberGroups {
            if constexpr (dg::ChangesEvenly<L>)
                return lens.numbers().groups();
            else
                throw dg::Error("camera: lens numbers: wanted a pinhole, a thin lens or a projection");
        },
        camera.lens);
}

void bind_iris(nb::module_& m) {
    using namespace dg;
    nb::class_<Iris>(m, "Iris")
        .def(nb::init<>())
        .def_static("polygon", &Iris::polygon, "blades"_a, "rotation_deg"_a, "curvature"_a)
        .def_static("image", [](const Picture& p) {
            return Iris::image(int(p.shape(1)), int(p.shape(0)),
                               std::vector<float>(p.data(), p.data() + p.size()));
        })
        .def_prop_ro("is_picture", [](const Iris& i) { return i.kind() == Iris::Kind::image; })
        .def_prop_ro("edges",
                     [](const Iris& i) {
                         std::vector<std::array<double, 2>> edges;
                         for (const Vec2d e : i.blades().edge) edges.push_back({e.x, e.y});
                         return edges;
                     },
                     "Unit vectors to the middles of the edges; empty: no blades.")
        .def_prop_ro("apothem", [](const Iris& i) { return i.blades().apothem; },
                     "Distance of straight edges; one unit is the radius of the circle of equal area.")
        .def_prop_ro("bend", [](const Iris& i) { return i.blades().bend; },
                     "1: arcs bent outward, -1: inward, 0: straight.")
        .def_prop_ro("arc_center", [](const Iris& i) { return i.blades().center; },
                     "Distance of the arcs' centres, along the vectors of the edges.")
        .def_prop_ro("arc_radius", [](const Iris& i) { return i.blades().arc_radius; })
        .def_prop_ro("outer_radius", &Iris::outer_radius);
}

void bind_thick_lens(nb::module_& m) {
    using namespace dg;
    nb::class_<ThickLens>(m, "ThickLens")
        .def("__init__",
             [](ThickLens* self, const Prescription& lens, double f_stop, const Iris& iris,
                double focus_distance_m, bool focus_from_sensor, double film_z_mm,
                const std::array<double, 2>& tilt_deg) {
                 new (self) ThickLens(
                     lens, {f_stop, iris, focus_distance_m,
                            focus_from_sensor ? FocusFrom::sensor : FocusFrom::pupil,
                            std::isnan(film_z_mm) ? std::nullopt : std::optional(film_z_mm),
                            {tilt_deg[0], tilt_deg[1]}});
             },
             "prescription"_a, "f_stop"_a, "iris"_a, "focus_distance_m"_a,
             "focus_from_sensor"_a = false,
             "film_z_mm"_a = std::numeric_limits<double>::quiet_NaN(),
             "tilt_deg"_a = std::array<double, 2>{0, 0})
        .def_prop_ro("h0", &ThickLens::h0)
        .def_prop_ro("transmittance", &ThickLens::transmittance)
        .def_prop_ro("f_stop", &ThickLens::f_stop)
        .def_prop_ro("film_z_mm", &ThickLens::film_z_mm, "On the lens's axis, in its frame.");
}

void bind_chief_rays(nb::module_& m) {
    using namespace dg;
    nb::class_<ChiefRays>(m, "ChiefRays")
        .def("rays", &chief_rays, "film_mm"_a,
             "(origins, directions), m, of the chief rays of film points (N, 2) (mm, upright).")
        .def("sees", &seen, "camera"_a, "film_mm"_a,
             "Whether light comes to film points (N, 2) (mm, upright) of the camera that these are of.")
        .def("film_points", &film_points, "points"_a, "at_infinity"_a = false,
             "Where the chief rays of points (N, 3) meet the film (mm, upright); NaN: behind the camera.");
}

/// Constructors, one per kind of camera.
void def_kinds(nb::class_<dg::Camera>& c) {
    using namespace dg;
    c.def_static("pinhole",
                    [](const Motion& world, double film_distance_mm, bool natural_vignetting) {
                        return Camera{world,
                                      Pinhole{film_distance_mm, natural_vignetting}};
                    },
                    "world_from_camera"_a, "film_distance_mm"_a, "natural_vignetting"_a = false)
        .def_static("thin",
                    [](const Motion& world, double film_distance_mm, double aperture_radius_mm,
                       double focus_distance_m, const Iris& iris, bool natural_vignetting,
                       const std::array<double, 2>& tilt_deg) {
                        return Camera{world, ThinLens{film_distance_mm, aperture_radius_mm,
                                                      focus_distance_m, iris, natural_vignetting,
                                                      {tilt_deg[0], tilt_deg[1]}}};
                    },
                    "world_from_camera"_a, "film_distance_mm"_a, "aperture_radius_mm"_a,
                    "focus_distance_m"_a, "iris"_a, "natural_vignetting"_a = false,
                    "tilt_deg"_a = std::array<double, 2>{0, 0})
        .def_static("thick",
                    [](const Motion& world, const ThickLens& lens) {
                        return Camera{world, lens};
                    },
                    "world_from_camera"_a, "lens"_a)
        .def_static("exact",
                    [](const Motion& world, const ExactLens& lens) {
                        return Camera{world, lens};
                    },
                    "world_from_camera"_a, "lens"_a)
        .def_static("projection",
                    [](const Motion& world, const ProjectionModel& model, const std::array<double, 2>& focal_mm,
                       const std::array<double, 2>& principal_mm, double aperture_radius_mm, double focus_distance_m,
                       const Iris& iris) {
                        return Camera{world, Projection{model, {focal_mm[0], focal_mm[1]},
                                                        {principal_mm[0], principal_mm[1]}, aperture_radius_mm,
                                                        focus_distance_m, iris}};
                    },
                    "world_from_camera"_a, "model"_a, "focal_mm"_a, "principal_mm"_a, "aperture_radius_mm"_a,
                    "focus_distance_m"_a, "iris"_a);
}

}  // namespace

void bind_camera(nb::module_& m) {
    using namespace dg;
    bind_iris(m), bind_thick_lens(m), bind_chief_rays(m);
    nb::class_<Camera> c(m, "Camera");
    def_kinds(c);
    c.def("change_lens", &change_lens, "times"_a, "cameras"_a,
             "The lens at some moments (fractions of the interval) is that of these cameras.")
        .def("change_setting", &change_setting, "times"_a, "iris_openings"_a, "film_shifts_mm"_a,
             "Radius of the iris, as a fraction of the lens's own, and shifts (K, 2) of the film.")
        .def_rw("sensor_stack", &Camera::sensor_stack, "Reflecting parts of the body, for ghosts and scatter alone.")
        .def_rw("scatter", &Camera::scatter, "How the parts of an exact lens scatter, where that is drawn.")
        .def("clip_near",
             [](Camera& camera, double distance_m, bool round) { camera.near_clip = {distance_m, round}; },
             "distance_m"_a, "round"_a,
             "Clips what is nearer than a plane across the axis, or than that radius; 0: nothing.")
        .def_prop_ro("lens_numbers", &lens_numbers,
                     "Numbers that change evenly, in groups. Pinhole: film distance (mm). Thin lens: film distance, iris radius (mm), "
             "1 / focus distance (1/m), tilts (deg). Projection: focal lengths; principal point; iris radius (mm); "
             "1 / focus distance.")
        .def("rays", &rays, "film_mm"_a, "u_lens"_a, "wavelength_nm"_a,
             "(origins, directions, weights) in the world for explicit film points (mm, upright).")
        .def("chief_rays", [](const Camera& camera) { return ChiefRays(camera.lens); },
             "Chief rays of the lens, in the camera's frame.");
}
