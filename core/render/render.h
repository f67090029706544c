// render.h -- renders a scene with a camera to a film: the only place that combines all three.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "camera/shutter.h"
#include "film/film.h"
#include "film/filter.h"
#include "render/render_counters.h"
#include "scene/scene.h"
#include "transport/path.h"
#include "transport/sharing/light_plan.h"

namespace dg {

struct LightGuide;   // light_guide.h
class FlareGuide;    // flare_guide.h
class ScatterGuide;  // scatter_guide.h

/// Lens ghosts, traced from the emitters (flare_pass.h).
struct FlarePlan {
    double per_sample = 0;   // paths for each sample index, over the whole frame; 0: no ghosts
    int order = 2;   // number of reflections: 2, or 2 and 4
    bool highlights = true;   // includes ghosts of bright reflections in the scene
    bool learned = true;   // false: uniform choice of ghosts and of points on the front, the reference
    bool maps = true;      // ghosts of small sources from maps (flare_sheets.h); false: by paths, the reference
    std::shared_ptr<const FlareGuide> guide;   // for this picture; null: each call builds one
};

/// Light scattered inside the lens, traced from the emitters (scatter_pass.h).
struct ScatterPlan {
    double per_sample = 0;   // paths per sample index, for the whole frame; 0: none
    bool nodes = true;       // smooth light goes to nodes several pixels apart (scatter_nodes.h); false: the reference
    std::shared_ptr<const ScatterGuide> guide;   // for this picture; null: each call builds one
};

/// Treatment of secondary wavelengths behind a dispersive lens.
enum class Dispersion {
    reproject,       // each has a separate film point (dispersion.h)
    end_secondary,   // terminated; the hero has four times the weight: the reference
};

/// A round with a number of samples for each pixel: count[i] samples from index begin[i] on, with i row by row over the
/// film's region. A round can be drawn in parts [first, last) of kParts, each with the same fraction of every pixel's
/// samples. The picture has the correct mean after each part, and the result is bit-identical for any split.
struct SampleRound {
    static constexpr std::uint32_t kParts = 1 << 16;
    std::span<const std::uint32_t> begin, count;
    std::uint32_t first = 0, last = kParts;

    /// Samples [begin, end) of the pixel that this part draws.
    std::array<std::uint32_t, 2> samples(std::size_t pixel) const {
        const auto until = [&](std::uint64_t part) {
            return std::uint32_t(begin[pixel] + count[pixel] * part / kParts);
        };
        return {until(first), until(last)};
    }
};

struct RenderSettings {
    Sensor sensor;
    std::uint32_t sample_begin = 0, sample_end = 1;
    SampleRound round;                          // replaces sample_begin and sample_end unless empty
    PixelBox window, hole;                      // draws only pixels inside `window` and outside `hole`; empty: all
    std::uint64_t seed = 0;
    int threads = 0;                            // 0: all
    Shutter shutter;                            // its duration is the time interval of the scene
    PathSettings path;
    Filter filter;
    Dispersion dispersion = Dispersion::reproject;
    LightPlan light;                            // none: off
    Technique technique = Technique::both;
    std::shared_ptr<const LightGuide> light_guide;   // for this plan; null: each call builds one
    FlarePlan flare;                            // needs an exact lens and a film with a flare layer
    ScatterPlan scatter;                        // needs an exact lens and a film with a flare layer
    std::shared_ptr<const PlateLight> plate;    // a photograph that lights objects; null: the materials of catchers do
};

/// Draws samples [sample_begin, sample_end) of every pixel of the film's region, or a part of a round.
/// `progress` is called from worker threads with the fraction done; if it returns false, rendering stops and the film
/// is invalid.
RenderCounters render(const Scene& scene, const Camera& camera, Film& film,
                      const RenderSettings& settings,
                      const std::function<bool(double)>& progress);

}  // namespace dg
