// render.h -- the one page where camera, scene and film meet.
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

/// Ghosts, drawn from the emitters (flare_pass.h); 0 paths per sample index, for the whole frame: none.
struct FlarePlan {
    double per_sample = 0;
    int order = 2;   // reflections: 2, or 4 as well
    bool highlights = true;   // of what other things send to the lens, too
    bool learned = true;   // false: all ghosts and the whole front alike, the plain reference
    bool maps = true;      // of the ghosts of small sources (flare_sheets.h); false: paths for all, the reference
    std::shared_ptr<const FlareGuide> guide;   // of this picture; null: each call makes its own
};

/// Light that the lens's own parts scatter, drawn from the emitters (scatter_pass.h).
struct ScatterPlan {
    double per_sample = 0;   // paths per sample index, for the whole frame; 0: none
    bool nodes = true;       // smooth light comes to nodes some pixels apart (scatter_nodes.h); false: the reference
    std::shared_ptr<const ScatterGuide> guide;   // of this picture; null: each call makes its own
};

/// Treatment of the other wavelengths of a path once glass has bent the hero's ray.
enum class Dispersion {
    reproject,       // each at its own film point (dispersion.h)
    end_secondary,   // dropped; the hero alone, at four times its weight: the plain reference
};

/// A round in which each pixel draws samples of its own: count[i] of them from index begin[i] on, i over
/// the rows of the film's region. It can be drawn in parts, [first, last) of kParts: of each pixel's
/// samples the same share, so that the picture has the right mean after each part, and the bits of the
/// whole do not depend on the parts.
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
    SampleRound round;                          // instead of these, unless empty
    PixelBox window, hole;                      // of the film only what lies in one and not in the other; empty: all
    std::uint64_t seed = 0;
    int threads = 0;                            // 0: all
    Shutter shutter;                            // its duration is the scene's interval
    PathSettings path;
    Filter filter;
    Dispersion dispersion = Dispersion::reproject;
    LightPlan light;                            // none: off
    Technique technique = Technique::both;
    std::shared_ptr<const LightGuide> light_guide;   // made for this plan; null: each call makes its own
    FlarePlan flare;                            // needs an exact lens, and a film with a layer for it
    ScatterPlan scatter;                        // the same; it is in the layer of flare
    std::shared_ptr<const PlateLight> plate;    // a photograph of the set; null: its materials send their own light
};

/// Draws samples [sample_begin, sample_end) of every pixel of the film's region, or a part of a round.
/// `progress` is called from worker threads with the fraction done; returning false stops early (the film is then invalid).
RenderCounters render(const Scene& scene, const Camera& camera, Film& film,
                      const RenderSettings& settings,
                      const std::function<bool(double)>& progress);

}  // namespace dg
