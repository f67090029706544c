// bind_render.cpp -- renders samples to a film.
#include <nanobind/operators.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <thread>

#include "bind/arrays.h"
#include "bind/record.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "render/flare/live/live_flare.h"
#include "render/pilot.h"
#include "render/render.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

/// Python's progress callback, called by any thread, at most every 100 ms.
class Progress {
  public:
    explicit Progress(nb::object callback) : callback_(std::move(callback)) {}

    bool operator()(double fraction) {
        if (dg::bind::is_ending_beside(caller_)) return false;
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
    const std::thread::id caller_ = std::this_thread::get_id();
    std::atomic<std::chrono::steady_clock::rep> last_{0};
    std::atomic<bool> stopped_{false};
};

/// Renders without Python's lock and calls its callback at intervals; returns whether it finished, and counters.
std::pair<bool, dg::RenderCounters> draw(const dg::Scene& scene, const dg::Camera& camera, dg::Film& film,
                                         const dg::RenderSettings& settings, nb::object callback) {
    Progress progress(std::move(callback));
    std::atomic<bool> complete{true};
    dg::bind::Unlocked release;
    const dg::RenderCounters counters = dg::render(scene, camera, film, settings, [&](double fraction) {
        const bool go = progress(fraction);
        if (!go) complete = false;
        return go;
    });
    return {complete.load(), counters};
}

using Counts = nb::ndarray<const std::uint32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Parts [first, last) of a round: `count` samples of each pixel from index `begin` on. Keeps the arrays alive.
struct Round {
    Counts begin, count;
    std::uint32_t first, last;
};

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

struct Counter {
    const char* name;
    std::uint64_t dg::RenderCounters::* value;
    const char* doc;
};

constexpr Counter kCounters[]{
    {"camera_rays", &dg::RenderCounters::camera_rays, "Samples that the camera drew."},
    {"stopped_rays", &dg::RenderCounters::stopped_rays, "Those that no light comes along."},
    {"rays", &dg::RenderCounters::rays, "Rays traced through the scene."},
    {"light_paths", &dg::RenderCounters::light_paths, "Paths from emitters."},
    {"splats_off_film", &dg::RenderCounters::splats_off_film, "Their light that passed the lens and missed the frame."},
    {"flare_paths", &dg::RenderCounters::flare_paths, "Paths of ghosts."},
    {"flare_rays", &dg::RenderCounters::flare_rays, "Their rays, one for each wavelength."},
    {"flare_hits", &dg::RenderCounters::flare_hits, "Those that came to the frame."},
    {"flare_arrivals", &dg::RenderCounters::flare_arrivals, "Light drawn from maps of ghosts."},
    {"scatter_paths", &dg::RenderCounters::scatter_paths, "Paths of light that the lens's parts scatter."},
    {"scatter_hits", &dg::RenderCounters::scatter_hits, "Those that came to the frame, with some wavelength."},
};

using Numbers = std::array<std::uint64_t, std::size(kCounters)>;
static_assert(sizeof(Numbers) == sizeof(dg::RenderCounters), "each counter has its row");

void bind_counters(nb::module_& m) {
    using dg::RenderCounters;
    nb::class_<RenderCounters> c(m, "RenderCounters", "What drawing counted; counters of parts add up.");
    dg::bind::def_fields_init(c, "Counts by name; 0 otherwise.");
    for (const auto& [name, value, doc] : kCounters) c.def_rw(name, value, doc);
    c.def(nb::self + nb::self)
        .def(nb::self == nb::self, nb::sig("def __eq__(self, other: object, /) -> bool"))
        .def("__repr__",
             [](const RenderCounters& counters) {
                 std::string text;
                 for (const auto& [name, value, doc] : kCounters)
                     text += (text.empty() ? "" : ", ") + std::string(name) + "=" + std::to_string(counters.*value);
                 return "RenderCounters(" + text + ")";
             })
        .def("__getstate__", [](const RenderCounters& counters) { return std::bit_cast<Numbers>(counters); })
        .def("__setstate__", [](RenderCounters& counters, const Numbers& numbers) {
            new (&counters) RenderCounters(std::bit_cast<RenderCounters>(numbers));
        });
}

}  // namespace

void bind_render(nb::module_& m) {
    using namespace dg;
    bind_counters(m);
    m.def("render",
          [](const Scene& scene, const Camera& camera, Film& film, RenderSettings settings,
             std::uint32_t begin, std::uint32_t end, nb::object callback) {
              settings.sample_begin = begin;
              settings.sample_end = end;
              return draw(scene, camera, film, settings, std::move(callback));
          },
          "scene"_a, "camera"_a, "film"_a, "settings"_a, "begin"_a, "end"_a, "progress"_a.none() = nb::none(),
          "Draws samples [begin, end) of every pixel. Returns whether all of them were, and counters.");

    nb::class_<LiveFlare>(m, "LiveFlare", "Ghosts of the brightest small sources for pictures that pass by.")
        .def(nb::init<>())
        .def("draw",
             [](LiveFlare& live, const Scene& scene, const Camera& camera, const RenderSettings& settings) {
                 const dg::Sensor& sensor = settings.sensor;
                 std::vector<float> rgb;
                 {
                     dg::bind::Unlocked release;
                     rgb = live.draw(scene, camera, settings);
                 }
                 return dg::bind::to_numpy(std::move(rgb), {std::size_t(sensor.height), std::size_t(sensor.width), 3});
             },
             "scene"_a, "camera"_a, "settings"_a, "Their light, linear Rec.709 (H, W, 3), some per cent off.")
        .def_prop_ro("sources", [](const LiveFlare& live) { return live.facts().sources; },
                     "Sources of the last picture; 0: all of it is black.")
        .def_prop_ro("ghosts", [](const LiveFlare& live) { return live.facts().ghosts; }, "Ghosts of the last picture.")
        .def_prop_ro("rays", [](const LiveFlare& live) { return live.facts().rays; }, "Exact rays of the last picture.")
        .def_prop_ro("arrivals", [](const LiveFlare& live) { return live.facts().arrivals; },
                     "Places at which light of the last picture landed.")
        .def_prop_ro("ray_arrivals", [](const LiveFlare& live) { return live.facts().ray_arrivals; },
                     "Arrivals of the last picture that were exact rays of their own.");

    m.def("pilot",
          [](const Scene& scene, const Camera& camera, const RenderSettings& settings) {
              dg::bind::Unlocked release;
              const LightPlan plan = pilot(scene, camera, settings);
              return std::tuple{plan.m1, plan.m2};
          },
          "scene"_a, "camera"_a, "settings"_a,
          "Numbers of light paths per sample index that pay: straight to the lens, and with bounces.");

    m.attr("ROUND_PARTS") = SampleRound::kParts;
    nb::class_<Round>(m, "SampleRound")
        .def(nb::init<Counts, Counts, std::uint32_t, std::uint32_t>(), "begin"_a, "count"_a, "first"_a, "last"_a,
             "count (H, W) samples of each pixel from index begin (H, W) on; of these the parts [first, last) "
             "of ROUND_PARTS.");
    m.def("render_round",
          [](const Scene& scene, const Camera& camera, Film& film, RenderSettings settings,
             const Round& round, nb::object callback) {
              settings.round = {per_pixel(round.begin, film, "begin"), per_pixel(round.count, film, "count"),
                                round.first, std::min(round.last, SampleRound::kParts)};
              return draw(scene, camera, film, settings, std::move(callback));
          },
          "scene"_a, "camera"_a, "film"_a, "settings"_a, "round"_a, "progress"_a.none() = nb::none(),
          "Draws a part of a round of adaptive sampling. Returns as render.");
}
