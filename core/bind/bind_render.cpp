// bind_render.cpp -- draw samples into a film.
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <atomic>
#include <chrono>

#include "bind/arrays.h"
#include "math/error.h"
#include "render/flare/flare_guide.h"
#include "render/light_guide.h"
#include "render/pilot.h"
#include "render/render.h"
#include "render/flare/scatter_guide.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

/// Python's callback, called at most every 100 ms from whichever thread comes first.
class Progress {
  public:
    explicit Progress(nb::object callback) : callback_(std::move(callback)) {}

    bool operator()(double fraction) {
        if (callback_.is_none()) return true;
        const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
        auto last = last_.load();
        constexpr auto kPeriod = std::chrono::steady_clock::duration(std::chrono::milliseconds(100)).count();
        if (now - last < kPeriod || !last_.compare_exchange_strong(last, now)) return !stopped_;
        nb::gil_scoped_acquire gil;
        try {
            if (!nb::cast<bool>(callback_(fraction))) stopped_ = true;
        } catch (nb::python_error& e) {
            e.discard_as_unraisable("daguerre progress callback");
            stopped_ = true;
        }
        return !stopped_;
    }

  private:
    nb::object callback_;
    std::atomic<std::chrono::steady_clock::rep> last_{0};
    std::atomic<bool> stopped_{false};
};

/// Draws with Python's lock released, its callback asked now and then.
auto draw(const dg::Scene& scene, const dg::Camera& camera, dg::Film& film,
          const dg::RenderSettings& settings, nb::object callback) {
    Progress progress(std::move(callback));
    std::atomic<bool> complete{true};
    dg::RenderCounters counters;
    {
        nb::gil_scoped_release release;
        counters = dg::render(scene, camera, film, settings, [&](double fraction) {
            const bool go = progress(fraction);
            if (!go) complete = false;
            return go;
        });
    }
    return std::tuple{complete.load(), counters.camera_rays, counters.stopped_rays, counters.rays,
                      counters.light_paths, counters.splats_off_film, counters.flare_paths,
                      counters.flare_rays, counters.flare_hits, counters.scatter_paths,
                      counters.scatter_hits};
}

using Corners = std::tuple<int, int, int, int>;
Corners corners(const dg::PixelBox& box) { return {box.x0, box.y0, box.x1, box.y1}; }
dg::PixelBox box_of(const Corners& c) { return {std::get<0>(c), std::get<1>(c), std::get<2>(c), std::get<3>(c)}; }

using Counts = nb::ndarray<const std::uint32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Counts per pixel of the film's region.
std::span<const std::uint32_t> per_pixel(const Counts& counts, const dg::Film& film, const char* what) {
    const dg::FilmLayout& l = film.layout();
    if (counts.shape(0) != std::size_t(l.height) || counts.shape(1) != std::size_t(l.width))
        throw dg::input_error("render", what,
                              "shape (" + std::to_string(l.height) + ", " + std::to_string(l.width) + ")",
                              "(" + std::to_string(counts.shape(0)) + ", " +
                                  std::to_string(counts.shape(1)) + ")");
    return {counts.data(), counts.size()};
}

}  // namespace

void bind_render(nb::module_& m) {
    using namespace dg;
    nb::class_<Filter>(m, "Filter")
        .def("__init__",
             [](Filter* f, const std::string& kind, float radius) {
                 const FilterKind k = filter_kind(kind);
                 new (f) Filter(k, radius > 0 ? radius : default_radius(k));
             },
             "kind"_a, "radius"_a = 0.f, "kind: box, gaussian, blackman_harris, mitchell; radius in px, 0: its default.");

    nb::class_<RenderSettings>(m, "RenderSettings")
        .def(nb::init<>())
        .def_prop_rw("resolution",
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
                     "Pixels (x0, y0, x1, y1) of the film that are drawn; all 0: each.")
        .def_prop_rw("hole", [](const RenderSettings& s) { return corners(s.hole); },
                     [](RenderSettings& s, Corners box) { s.hole = box_of(box); },
                     "Pixels (x0, y0, x1, y1) of the film that are not drawn.")
        .def_rw("seed", &RenderSettings::seed)
        .def_rw("threads", &RenderSettings::threads)
        .def_rw("shutter", &RenderSettings::shutter)
        .def_rw("filter", &RenderSettings::filter)
        .def_prop_rw("light_paths",
                     [](const RenderSettings& s) { return std::tuple{s.light.m1, s.light.m2}; },
                     [](RenderSettings& s, std::tuple<double, double> m) {
                         for (const double n : {std::get<0>(m), std::get<1>(m)})
                             if (!(n >= 0 && n <= kMostLightPaths))
                                 throw input_error("render", "light paths",
                                                   "0 .. 1e9 per sample index", std::to_string(n));
                         s.light = {std::get<0>(m), std::get<1>(m)};
                     },
                     "Per sample index: straight from an emitter to the lens, and with bounces.")
        .def("prepare_light",
             [](RenderSettings& s, const Scene& scene, const Camera& camera) {
                 s.light_guide.reset();
                 if (s.light.off()) return;
                 s.light_guide = std::make_shared<const LightGuide>(scene, camera, s.sensor,
                                                                    s.filter.radius(), s.light);
             },
             "scene"_a, "camera"_a, nb::call_guard<nb::gil_scoped_release>(), nb::keep_alive<1, 2>(),
             "Finds once what light paths are drawn with; to be called again after any change.")
        .def_prop_rw("flare", [](const RenderSettings& s) { return s.flare.per_sample; },
                     [](RenderSettings& s, double paths) {
                         if (!(paths >= 0 && paths <= kMostLightPaths))
                             throw input_error("render", "flare", "0 .. 1e9 paths per sample index",
                                               std::to_string(paths));
                         s.flare.per_sample = paths;
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
        .def("prepare_flare",
             [](RenderSettings& s, const Scene& scene, const Camera& camera) {
                 s.flare.guide.reset();
                 const auto guide = std::make_shared<const FlareGuide>(
                     std::make_shared<const FlareAim>(scene, camera, s), s);
                 s.flare.guide = guide;
                 return !guide->empty();
             },
             "scene"_a, "camera"_a, nb::call_guard<nb::gil_scoped_release>(), nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 3>(),
             "Finds once what ghosts are drawn by; to be called again after any change. False: no light "
             "makes a ghost.")
        .def_prop_rw("scatter", [](const RenderSettings& s) { return s.scatter.per_sample; },
                     [](RenderSettings& s, double paths) {
                         if (!(paths >= 0 && paths <= kMostLightPaths))
                             throw input_error("render", "scatter", "0 .. 1e9 paths per sample index",
                                               std::to_string(paths));
                         s.scatter.per_sample = paths;
                     },
                     "Light that the lens's parts scatter: paths per sample index.")
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
             "scene"_a, "camera"_a, nb::call_guard<nb::gil_scoped_release>(), nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 3>(),
             "Finds once what scattered light is drawn by; to be called again after any change. False: nothing "
             "shines, or nothing scatters.")
        .def_prop_rw("technique", [](const RenderSettings& s) { return int(s.technique); },
                     [](RenderSettings& s, const std::string& name) {
                         if (name == "both") s.technique = Technique::both;
                         else if (name == "camera") s.technique = Technique::camera;
                         else if (name == "light") s.technique = Technique::light;
                         else throw input_error("render", "technique", "both, camera or light", name);
                     })
        .def_prop_rw("max_depth", [](const RenderSettings& s) { return s.path.max_depth; },
                     [](RenderSettings& s, int v) { s.path.max_depth = v; })
        .def_prop_rw("dispersion",
                     [](const RenderSettings& s) { return int(s.dispersion); },
                     [](RenderSettings& s, const std::string& name) {
                         if (name == "reproject") s.dispersion = Dispersion::reproject;
                         else if (name == "end_secondary") s.dispersion = Dispersion::end_secondary;
                         else throw input_error("render", "dispersion", "reproject or end_secondary", name);
                     })
        .def_prop_rw("strategy",
                     [](const RenderSettings& s) { return int(s.path.strategy); },
                     [](RenderSettings& s, const std::string& name) {
                         if (name == "mis") s.path.strategy = PathSettings::Strategy::mis;
                         else if (name == "light") s.path.strategy = PathSettings::Strategy::light;
                         else if (name == "bsdf") s.path.strategy = PathSettings::Strategy::bsdf;
                         else throw input_error("render", "strategy", "mis, light or bsdf", name);
                     });

    m.def("render",
          [](const Scene& scene, const Camera& camera, Film& film, RenderSettings settings,
             std::uint32_t begin, std::uint32_t end, nb::object callback) {
              settings.sample_begin = begin;
              settings.sample_end = end;
              return draw(scene, camera, film, settings, std::move(callback));
          },
          "scene"_a, "camera"_a, "film"_a, "settings"_a, "begin"_a, "end"_a, "progress"_a.none() = nb::none(),
          "Draws samples [begin, end) of every pixel. Returns (complete, camera rays, "
          "stopped rays, rays, light paths, splats off the film, flare paths, flare rays, those on film, scatter "
          "paths, those on film).");

    m.def("pilot",
          [](const Scene& scene, const Camera& camera, const RenderSettings& settings) {
              nb::gil_scoped_release release;
              const LightPlan plan = pilot(scene, camera, settings);
              return std::tuple{plan.m1, plan.m2};
          },
          "scene"_a, "camera"_a, "settings"_a,
          "Numbers of light paths per sample index that pay: straight to the lens, and with bounces.");

    m.attr("ROUND_PARTS") = SampleRound::kParts;
    m.def("render_round",
          [](const Scene& scene, const Camera& camera, Film& film, RenderSettings settings,
             const Counts& begin, const Counts& count, std::uint32_t first, std::uint32_t last,
             nb::object callback) {
              settings.round = {per_pixel(begin, film, "begin"), per_pixel(count, film, "count"), first,
                                std::min(last, SampleRound::kParts)};
              return draw(scene, camera, film, settings, std::move(callback));
          },
          "scene"_a, "camera"_a, "film"_a, "settings"_a, "begin"_a, "count"_a, "first"_a, "last"_a,
          "progress"_a.none() = nb::none(),
          "Draws count (H, W) samples of each pixel from index begin (H, W) on; of these the parts "
          "[first, last) of ROUND_PARTS.");
}
