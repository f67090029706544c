// bind_render_settings.cpp -- render settings: frame, samples, light transport, references.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <initializer_list>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "render/flare/flare_guide.h"
#include "render/flare/scatter_guide.h"
#include "render/light_guide.h"
#include "render/render.h"
#include "render/truth/projected_plate.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using namespace dg;
using Settings = nb::class_<RenderSettings>;
using Pixels = nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using Corners = std::tuple<int, int, int, int>;

Corners corners(const PixelBox& box) { return {box.x0, box.y0, box.x1, box.y1}; }
PixelBox box_of(const Corners& c) { return {std::get<0>(c), std::get<1>(c), std::get<2>(c), std::get<3>(c)}; }

/// Validated numbers of paths per sample index.
double paths(double n, const char* what, const char* wanted) {
    if (!(n >= 0 && n <= kMostLightPaths)) throw input_error("render", what, wanted, std::to_string(n));
    return n;
}

template <typename Enum>
struct Choice {
    const char* name;
    Enum value;
};

template <typename Enum>
Enum choose(const std::string& name, const char* what, const char* wanted,
            std::initializer_list<Choice<Enum>> known) {
    for (const auto& [key, value] : known)
        if (name == key) return value;
    throw input_error("render", what, wanted, name);
}

void bind_filter(nb::module_& m) {
    nb::class_<Filter>(m, "Filter")
        .def("__init__",
             [](Filter* f, const std::string& kind, float radius) {
                 const FilterKind k = filter_kind(kind);
                 new (f) Filter(k, radius > 0 ? radius : default_radius(k));
             },
             "kind"_a, "radius"_a = 0.f,
             "kind: box, gaussian, blackman_harris, mitchell, tent; radius in px, 0: its default.");
}

void def_frame(Settings& c) {
    c.def_prop_rw("resolution",
                  [](const RenderSettings& s) { return std::tuple{s.sensor.width, s.sensor.height}; },
                  [](RenderSettings& s, std::tuple<int, int> v) {
                      std::tie(s.sensor.width, s.sensor.height) = v;
                  })
        .def_prop_rw("sensor_size_mm",
                     [](const RenderSettings& s) {
                         return std::tuple{s.sensor.width_mm, s.sensor.height_mm};
                     },
                     [](RenderSettings& s, std::tuple<double, double> v) {
                         std::tie(s.sensor.width_mm, s.sensor.height_mm) = v;
                     })
        .def_prop_rw("sensor_center_mm",
                     [](const RenderSettings& s) {
                         return std::tuple{s.sensor.center_mm.x, s.sensor.center_mm.y};
                     },
                     [](RenderSettings& s, std::tuple<double, double> v) {
                         s.sensor.center_mm = {std::get<0>(v), std::get<1>(v)};
                     })
        .def_prop_rw("window", [](const RenderSettings& s) { return corners(s.window); },
                     [](RenderSettings& s, Corners box) { s.window = box_of(box); },
                     "Only these pixels (x0, y0, x1, y1) of the film are drawn; all 0: each.")
        .def_prop_rw("hole", [](const RenderSettings& s) { return corners(s.hole); },
                     [](RenderSettings& s, Corners box) { s.hole = box_of(box); },
                     "These pixels (x0, y0, x1, y1) of the film are not drawn.")
        .def_rw("filter", &RenderSettings::filter);
}

void def_sampling(Settings& c) {
    c.def_rw("seed", &RenderSettings::seed)
        .def_rw("threads", &RenderSettings::threads)
        .def_rw("shutter", &RenderSettings::shutter)
        .def_prop_rw("max_depth", [](const RenderSettings& s) { return s.path.max_depth; },
                     [](RenderSettings& s, int n) { s.path.max_depth = n; });
}

void def_light_paths(Settings& c) {
    c.def_prop_rw("light_paths",
                  [](const RenderSettings& s) { return std::tuple{s.light.m1, s.light.m2}; },
                  [](RenderSettings& s, std::tuple<double, double> m) {
                      constexpr auto kWanted = "0 .. 1e9 per sample index";
                      s.light.m1 = paths(std::get<0>(m), "light paths", kWanted);
                      s.light.m2 = paths(std::get<1>(m), "light paths", kWanted);
                  },
                  "Per sample index: straight from an emitter to the lens, and with bounces.")
        .def("prepare_light",
             [](RenderSettings& s, const Scene& scene, const Camera& camera) {
                 s.light_guide.reset();
                 if (s.light.off()) return;
                 s.light_guide = std::make_shared<const LightGuide>(scene, camera, s.sensor,
                                                                    s.filter.radius(), s.light);
             },
             "scene"_a, "camera"_a, nb::call_guard<dg::bind::Unlocked>(), nb::keep_alive<1, 2>(),
             "Finds once what light paths are drawn with; to be called again after any change.");
}

void def_flare(Settings& c) {
    c.def_prop_rw("flare", [](const RenderSettings& s) { return s.flare.per_sample; },
                  [](RenderSettings& s, double n) {
                      s.flare.per_sample = paths(n, "flare", "0 .. 1e9 paths per sample index");
                  },
                  "Ghosts: paths per sample index.")
        .def_prop_rw("flare_order", [](const RenderSettings& s) { return s.flare.order; },
                     [](RenderSettings& s, int order) {
                         if (order != 2 && order != 4)
                             throw input_error("render", "flare order", "2 or 4", std::to_string(order));
                         s.flare.order = order;
                     },
                     "Reflections of ghosts: 2, or 4 as well.")
        .def_prop_rw("flare_highlights", [](const RenderSettings& s) { return s.flare.highlights; },
                     [](RenderSettings& s, bool on) { s.flare.highlights = on; },
                     "Ghosts of what other things send to the lens.")
        .def_prop_ro("flare_survey",
                     [](const RenderSettings& s) {
                         using Facts = std::tuple<int, std::uint64_t>;
                         if (!s.flare.guide) return Facts{0, 0};
                         return Facts{s.flare.guide->aim().spots(), s.flare.guide->aim().survey_rays()};
                     },
                     "Bright spots found among that, and the rays that it took.")
        .def_prop_rw("flare_learned", [](const RenderSettings& s) { return s.flare.learned; },
                     [](RenderSettings& s, bool learned) { s.flare.learned = learned; },
                     "False: all ghosts and the whole front alike, the plain reference.")
        .def_prop_rw("flare_maps", [](const RenderSettings& s) { return s.flare.maps; },
                     [](RenderSettings& s, bool maps) { s.flare.maps = maps; },
                     "False: paths alone, also for the ghosts of small sources; the reference. A film with bands needs it.")
        .def_prop_ro("flare_maps_failed",
                     [](const RenderSettings& s) { return s.flare.guide && s.flare.guide->sheets().failed(); },
                     "The maps of ghosts were too wrong: there are none, and paths draw all.")
        .def_prop_ro("flare_ghosts_by_rays",
                     [](const RenderSettings& s) { return s.flare.guide ? s.flare.guide->sheets().by_rays() : 0; },
                     "Ghosts whose own map was too wrong: rays alone bring their light.")
        .def_prop_ro("flare_map_error",
                     [](const RenderSettings& s) -> std::optional<double> {
                         const FlareSheets* sheets = s.flare.guide ? &s.flare.guide->sheets() : nullptr;
                         if (!sheets || (sheets->empty() && !sheets->failed())) return std::nullopt;
                         return sheets->error();
                     },
                     "Error of the maps of ghosts, relative (flare_sheets.h); None: there are none.")
        .def("prepare_flare",
             [](RenderSettings& s, const Scene& scene, const Camera& camera) {
                 s.flare.guide.reset();
                 const auto guide = std::make_shared<const FlareGuide>(
                     std::make_shared<const FlareAim>(scene, camera, s), s);
                 s.flare.guide = guide;
                 return !guide->empty();
             },
             "scene"_a, "camera"_a, nb::call_guard<dg::bind::Unlocked>(), nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 3>(),
             "Finds once what ghosts are drawn by; to be called again after any change. False: no light "
             "makes a ghost.");
}

void def_scatter(Settings& c) {
    c.def_prop_rw("scatter", [](const RenderSettings& s) { return s.scatter.per_sample; },
                  [](RenderSettings& s, double n) {
                      s.scatter.per_sample = paths(n, "scatter", "0 .. 1e9 paths per sample index");
                  },
                  "Light that the lens's parts scatter: paths per sample index.")
        .def_prop_rw("scatter_nodes", [](const RenderSettings& s) { return s.scatter.nodes; },
                     [](RenderSettings& s, bool nodes) { s.scatter.nodes = nodes; },
                     "False: each path brings light to the pixels of its own place alone; the reference.")
        .def("prepare_scatter",
             [](RenderSettings& s, const Scene& scene, const Camera& camera) {
                 s.scatter.guide.reset();
                 const bool same = s.flare.guide && s.flare.guide->aim().is_of(scene, camera);
                 const auto guide = std::make_shared<const ScatterGuide>(
                     same ? s.flare.guide->shared_aim() : std::make_shared<const FlareAim>(scene, camera, s),
                     scene, camera, s);
                 s.scatter.guide = guide;
                 return !guide->empty();
             },
             "scene"_a, "camera"_a, nb::call_guard<dg::bind::Unlocked>(), nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 3>(),
             "Finds once what scattered light is drawn by; to be called again after any change. False: nothing "
             "shines, or nothing scatters.");
}

void def_background(Settings& c) {
    c.def_prop_rw("transparent",
                  [](const RenderSettings& s) { return s.path.background == Background::transparent; },
                  [](RenderSettings& s, bool transparent) {
                      s.path.background = transparent ? Background::transparent : Background::environment;
                      s.light.sky = !transparent;
                  },
                  "The lens does not see the environment; light from there stays.")
        .def_prop_rw("see_through", [](const RenderSettings& s) { return s.path.see_through; },
                     [](RenderSettings& s, bool on) { s.path.see_through = on; },
                     "Smooth glass does not cover what lies straight behind it.")
        .def("set_plate",
             [](RenderSettings& s, const Scene& scene, const Camera& camera, const RenderSettings& taken,
                const Pixels& pixels) {
                 std::vector<Rgb> rgb(pixels.shape(0) * pixels.shape(1));
                 for (std::size_t i = 0; i < rgb.size(); ++i)
                     rgb[i] = {pixels.data()[3 * i], pixels.data()[3 * i + 1], pixels.data()[3 * i + 2]};
                 s.plate = std::make_shared<const ProjectedPlate>(scene, camera, taken, std::move(rgb));
             },
             "scene"_a, "camera"_a, "taken"_a, "pixels"_a, nb::keep_alive<1, 2>(),
             "Photograph of the set (H, W, 3), cd/m2, by another camera and its settings.");
}

/// Choice of a technique where several apply, to compare them.
void def_references(Settings& c) {
    c.def_prop_rw("technique", [](const RenderSettings& s) { return int(s.technique); },
                  [](RenderSettings& s, const std::string& name) {
                      s.technique = choose<Technique>(name, "technique", "both, camera or light",
                                                      {{"both", Technique::both},
                                                       {"camera", Technique::camera},
                                                       {"light", Technique::light}});
                  })
        .def_prop_rw("dispersion", [](const RenderSettings& s) { return int(s.dispersion); },
                     [](RenderSettings& s, const std::string& name) {
                         s.dispersion = choose<Dispersion>(name, "dispersion", "reproject or end_secondary",
                                                           {{"reproject", Dispersion::reproject},
                                                            {"end_secondary", Dispersion::end_secondary}});
                     })
        .def_prop_rw("strategy", [](const RenderSettings& s) { return int(s.path.strategy); },
                     [](RenderSettings& s, const std::string& name) {
                         using Strategy = PathSettings::Strategy;
                         s.path.strategy = choose<Strategy>(name, "strategy", "mis, light or bsdf",
                                                            {{"mis", Strategy::mis},
                                                             {"light", Strategy::light},
                                                             {"bsdf", Strategy::bsdf}});
                     });
}

}  // namespace

void bind_render_settings(nb::module_& m) {
    bind_filter(m);
    Settings c(m, "RenderSettings");
    c.def(nb::init<>());
    def_frame(c);
    def_sampling(c);
    def_light_paths(c);
    def_flare(c);
    def_scatter(c);
    def_background(c);
    def_references(c);
}
