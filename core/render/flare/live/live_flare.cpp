#include "render/flare/live/live_flare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "math/error.h"
#include "math/sampler.h"
#include "render/flare/live/drawn_ghosts.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr double kShare = 0.15;       // least share of all light of a source
constexpr double kFewestArrivals = 3e5, kMostArrivals = 5.6e5;
constexpr double kFewSteep = 0.2, kMostSteep = 0.6;   // share of steep squares for fewest and most arrivals
constexpr double kDim = 0.0015;        // limit of the share of dropped ghosts
constexpr int kShadows = 512, kSequence = -7;
constexpr int kLayers = 4;            // added in a fixed order, for results independent of threads
constexpr float kMm2 = 1e6f;          // in 1 m2

/// Number of arrivals for a noise of a few percent. Arrivals in steep squares have a higher variance.
double arrivals_for(double steep_share) {
    const double t = (steep_share - kFewSteep) / (kMostSteep - kFewSteep);
    return std::lerp(kFewestArrivals, kMostArrivals, std::clamp(t, 0., 1.));
}

/// Estimated unoccluded share of a source.
float free_share(const FlareAim& aim, const SmallSource& source) {
    const MapRays rays(aim.camera(), aim.sensor(), aim.ghost_lens(), aim.steps(0), source.shape);
    float seen = 0;
    int all = 0;
    for (int i = 0; i < kShadows; ++i) {
        PathSampler sampler(source.source, kSequence, std::uint32_t(i), 0);
        const CameraRandom u = sampler.camera();
        const SmallSource::Point& p = source.point((float(i) + 0.5f) / kShadows);   // each point equally often
        const auto shadow = rays.shadow({u.lens * 2 - Vec2f{1, 1}, p.shift, 0}, p.from, p.moment.time);
        if (shadow) ++all, seen += aim.scene().visibility_along(*shadow, Wavelengths::sample(u.lambda))[0];
    }
    return all > 0 ? seen / float(all) : 0;
}

std::vector<LiveSource> sources_of(const FlareAim& aim) {
    double all = 0;
    for (int s = 0; s < aim.sources().count(); ++s) all += aim.sources().strength(s);
    std::vector<LiveSource> chosen;
    for (int s = 0; s < aim.sources().count(); ++s) {
        if (!(aim.sources().strength(s) > kShare * all)) continue;
        auto small = small_source(aim, s);
        if (!small || !(small->luminance() > 0)) continue;
        const float free = free_share(aim, *small);
        if (free > 0) chosen.emplace_back(std::move(*small), free);
    }
    return chosen;
}

/// Distributes ghosts over layers of similar worth, by decreasing brightness.
std::array<std::vector<LiveGhost*>, kLayers> layers_of(const std::vector<DrawnGhost>& all) {
    std::array<std::vector<LiveGhost*>, kLayers> layers;
    std::array<double, kLayers> worth{};
    for (const DrawnGhost& own : all) {
        const auto least = std::size_t(std::ranges::min_element(worth) - worth.begin());
        layers[least].push_back(own.ghost.get()), worth[least] += own.worth;
    }
    return layers;
}

/// Draws on layers that are added in a fixed order, so that the result is bit-identical for any number of threads.
std::vector<float> draw_all(const std::vector<DrawnGhost>& all, const Sensor& sensor, float unit, int threads) {
    const auto ghosts = layers_of(all);
    std::vector<std::unique_ptr<LightLayer>> layers(kLayers);
    parallel_tasks(threads, kLayers, [&](std::int64_t k) {
        auto& layer = layers[std::size_t(k)];
        layer = std::make_unique<LightLayer>(sensor.width, sensor.height);
        for (LiveGhost* const ghost : ghosts[std::size_t(k)]) ghost->draw(*layer, unit);
    });
    for (int k = 1; k < kLayers; ++k) layers[0]->add(*layers[std::size_t(k)]);
    return layers[0]->pixels();
}

}  // namespace

std::vector<float> LiveFlare::draw(const Scene& scene, const Camera& camera, RenderSettings settings) {
    if (!std::holds_alternative<ExactLens>(camera.lens))
        throw input_error("live flare", "lens", "the exact model of a lens", "an ideal lens");
    const std::scoped_lock lock(drawing_);
    facts_ = {};
    settings.flare.highlights = false, settings.flare.order = 2;
    const Sensor& sensor = settings.sensor;
    const FlareAim aim(scene, camera, settings);
    if (aim.pairs() == 0) return std::vector<float>(std::size_t(3) * sensor.width * sensor.height);
    std::vector<LiveSource> sources = sources_of(aim);
    std::vector<std::vector<std::optional<KnownGhost>>> known(sources.size());
    std::vector<DrawnGhost> all;
    const bool keeps = GhostPlaces::can_keep(camera) && places_.set_lens(camera, sensor);
    for (std::size_t s = 0; s < sources.size(); ++s) {
        MapSource& shape = sources[s].small.shape;
        if (keeps) {
            shape.turn = GhostPlaces::turn_of(camera, shape);
            known[s] = places_.of(aim, shape, settings.threads);
        }
        std::ranges::move(ghosts_of(aim, sources[s], sensor, keeps ? &known[s] : nullptr, settings.threads),
                          std::back_inserter(all));
    }
    const double worth = choose(all, sensor, kDim);
    double steep = 0;
    for (const DrawnGhost& own : all) steep += own.ghost->steep_worth();
    const double arrivals = arrivals_for(steep / worth) / worth;   // per unit of worth
    parallel_tasks(settings.threads, std::int64_t(all.size()),
                   [&](std::int64_t i) { all[std::size_t(i)].ghost->refine(arrivals); });
    const double per_px = double(kMm2) / std::get<ExactLens>(camera.lens).h0() / sensor.mm2_per_px();
    std::vector<float> rgb = draw_all(all, sensor, float(per_px) * settings.shutter.weight(), settings.threads);
    facts_.rays = keeps ? places_.rays() : 0;
    facts_.sources = int(sources.size()), facts_.ghosts = int(all.size());
    for (const DrawnGhost& own : all) {
        facts_.rays += own.ghost->rays(), facts_.arrivals += own.ghost->arrivals();
        facts_.ray_arrivals += own.ghost->ray_arrivals();
    }
    return rgb;
}

}  // namespace dg
