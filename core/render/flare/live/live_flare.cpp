#include "render/flare/live/live_flare.h"

#include <algorithm>
#include <memory>

#include "math/error.h"
#include "math/sampler.h"
#include "render/flare/live/live_ghost.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr double kShare = 0.15;       // of all light, that a source must bring
constexpr double kArrivals = 4e5;
constexpr double kDim = 0.0015;        // share of all that the ghosts that are left out are worth, at most
constexpr int kShadows = 512, kSequence = -7;
constexpr int kLayers = 4;            // which tasks draw on, and which are added in order: no bit depends on threads
constexpr float kMm2 = 1e6f;          // in 1 m2

/// Share of some rays to the source that are free.
float free_share(const FlareAim& aim, const SmallSource& source) {
    const MapRays rays(aim.camera(), aim.sensor(), aim.ghost_lens(), aim.steps(0), source.shape);
    float seen = 0;
    int all = 0;
    for (int i = 0; i < kShadows; ++i) {
        PathSampler sampler(source.source, kSequence, std::uint32_t(i), 0);
        const CameraRandom u = sampler.camera();
        const SmallSource::Point& p = source.point((float(i) + 0.5f) / kShadows);   // each as often as any other
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

/// A ghost with the rays that it is made of.
struct Own {
    std::unique_ptr<MapRays> rays;
    std::unique_ptr<LiveGhost> ghost;
    double worth = 0;
};

std::vector<Own> ghosts_of(const FlareAim& aim, const std::vector<LiveSource>& sources, int threads) {
    const auto pairs = std::size_t(aim.pairs());
    std::vector<Own> all(sources.size() * pairs);
    parallel_tasks(threads, std::int64_t(all.size()), [&](std::int64_t i) {
        const LiveSource& source = sources[std::size_t(i) / pairs];
        Own& own = all[std::size_t(i)];
        own.rays = std::make_unique<MapRays>(aim.camera(), aim.sensor(), aim.ghost_lens(),
                                             aim.steps(int(std::size_t(i) % pairs)), source.small.shape);
        own.ghost = std::make_unique<LiveGhost>(*own.rays, source, aim.sensor(), std::uint64_t(i));
    });
    return all;
}

/// Keeps those that bring light, the brightest first, without those that nobody would miss; returns what they are worth.
double choose(std::vector<Own>& all, const Sensor& sensor) {
    std::erase_if(all, [](const Own& own) { return own.ghost->empty(); });
    FlareTiles tiles(sensor);
    for (const Own& own : all) own.ghost->add_to(tiles);
    tiles.finish();
    double worth = 0;
    for (Own& own : all) worth += own.worth = own.ghost->weigh(tiles);
    std::ranges::stable_sort(all, std::greater{}, &Own::worth);
    double left = worth;
    std::size_t count = 0;
    while (count < all.size() && left > kDim * worth) left -= all[count++].worth;
    all.erase(all.begin() + std::ptrdiff_t(count), all.end());
    return worth - left;
}

/// On layers that are added in their order: the same bits on any number of threads.
std::vector<float> draw_all(const std::vector<Own>& all, const Sensor& sensor, float unit, int threads) {
    std::vector<std::unique_ptr<LightLayer>> layers(kLayers);
    parallel_tasks(threads, kLayers, [&](std::int64_t k) {
        auto& layer = layers[std::size_t(k)];
        layer = std::make_unique<LightLayer>(sensor.width, sensor.height);
        for (std::size_t i = std::size_t(k); i < all.size(); i += kLayers) all[i].ghost->draw(*layer, unit);
    });
    for (int k = 1; k < kLayers; ++k) layers[0]->add(*layers[std::size_t(k)]);
    return layers[0]->pixels();
}

}  // namespace

std::vector<float> LiveFlare::draw(const Scene& scene, const Camera& camera, RenderSettings settings) {
    if (!std::holds_alternative<ExactLens>(camera.lens))
        throw input_error("live flare", "lens", "the exact model of a lens", "an ideal lens");
    facts_ = {};
    settings.flare.highlights = false, settings.flare.order = 2;
    const Sensor& sensor = settings.sensor;
    const FlareAim aim(scene, camera, settings);
    if (aim.pairs() == 0) return std::vector<float>(std::size_t(3) * sensor.width * sensor.height);
    const std::vector<LiveSource> sources = sources_of(aim);
    std::vector<Own> all = ghosts_of(aim, sources, settings.threads);
    const double worth = choose(all, sensor);
    parallel_tasks(settings.threads, std::int64_t(all.size()),
                   [&](std::int64_t i) { all[std::size_t(i)].ghost->refine(kArrivals / worth); });
    const double per_px = double(kMm2) / std::get<ExactLens>(camera.lens).h0() / sensor.mm2_per_px();
    std::vector<float> rgb = draw_all(all, sensor, float(per_px) * settings.shutter.weight(), settings.threads);
    facts_.sources = int(sources.size()), facts_.ghosts = int(all.size());
    for (const Own& own : all) facts_.rays += own.ghost->rays(), facts_.arrivals += own.ghost->arrivals();
    return rgb;
}

}  // namespace dg
