#include "render/flare/flare_learn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/flare/flare_weights.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr double kBlindPair = 0.02;   // defensive share of paths with a pair that is not learned
constexpr float kBlindCell = 0.02f;   // least defensive share of paths with a front point that is not learned
constexpr float kFewHits = 8;         // a pair with fewer hits is drawn by the defensive distribution
constexpr double kPooled = 0.1;       // share of a source's paths that uses the mean ghost weights of all sources
// Numbers of rays for all pairs together, in three passes: the rectangle of each source; ghosts and their approximate
// rectangles; the final distributions. The last two are per pixel, within limits.
constexpr double kScouts = 1 << 16;
constexpr int kFewestScouts = 8, kMostScouts = 256;   // per pair
struct Rays {
    double least, most, per_pixel;
};
constexpr Rays kWide{1 << 20, 1 << 21, 2}, kFine{1 << 18, 1 << 20, 1};
constexpr int kFewest = 32, kMost = 4096;   // per pair, in the second pass
constexpr int kSearched = 256, kZooms = 5, kZoomRays = 64;   // search: least rays without a hit; steps; rays per step
constexpr double kReflected = 0.3;    // root of the cost of a shadow ray over the cost of a path through the scene
constexpr int kLook = 256;            // rays that find the rectangle of the cells
constexpr std::size_t kMostPairs = 4096;    // limit of pairs in the last pass
constexpr int kLeastAcross = 8, kMostAcross = 64;   // cells
constexpr int kPerCell = 2, kRounds = 4;   // rays per cell; rounds of the last pass
constexpr int kGrowths = 20;   // limit of enlargements of a rectangle

class Learner {
  public:
    Learner(const FlareAim& aim, int threads, const std::vector<bool>& mapped)
        : aim_(aim), threads_(threads), mapped_(mapped), strength_(aim.sources().count()), visible_(strength_.size()),
          front_(strength_.size()) {}
    FlareKnowledge learn();

  private:
    int sources() const { return aim_.sources().count(); }
    int ghosts() const { return aim_.ghosts(); }
    /// Whether maps draw the pair, source x ghosts + ghost.
    bool leaves(std::size_t pair) const {
        const std::size_t source = pair / std::size_t(ghosts());
        return source < mapped_.size() && mapped_[source] && int(pair) % ghosts() < aim_.pairs();
    }
    /// Whether maps draw all ghosts of the source.
    bool leaves_source(int source) const { return leaves(std::size_t(source + 1) * ghosts() - 1); }
    double count(const Rays& rays) const;
    double share_of_pair(int source) const;
    FlareRectangle scout(int source) const;
    std::vector<FlareFound> look_wide();
    FlareTiles tiles_of(const std::vector<FlareFound>& found) const;
    std::vector<std::size_t> order_of(const std::vector<double>& weights) const;
    FlareFound search(FlareFound found) const;
    FlareRectangle narrow(const FlareFound& wide) const;
    FlareFound look_closely(const FlareFound& wide, const FlareTiles& tiles, int across) const;
    FlareFound look_into(const FlareProbe& what, const FlareTiles& tiles, int across) const;
    FlareCells cells_of(const FlareFound& wide, const FlareFound& fine, const FlareWeights& weights) const;
    void pool(std::vector<double>& weights) const;
    std::vector<double> blind() const;
    DiscreteDistribution choice(std::vector<double> weights) const;

    const FlareAim& aim_;
    int threads_;
    const std::vector<bool>& mapped_;
    std::vector<double> strength_, visible_;   // per source
    double all_strength_ = 0;
    std::vector<FlareRectangle> front_;        // per source: the rectangle where its light enters
};

FlareKnowledge Learner::learn() {
    const std::vector<FlareFound> wide = look_wide();
    std::vector<double> weights(wide.size());
    const FlareTiles first = tiles_of(wide);
    for (std::size_t i = 0; i < wide.size(); ++i) weights[i] = FlareWeights(wide[i], first, 1).sum;
    const std::vector<std::size_t> order = order_of(weights);
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0), total = count(kFine);
    std::vector<FlareFound> fine(order.size());
    std::vector<int> across(order.size());
    parallel_tasks(threads_, std::int64_t(order.size()), [&](std::int64_t k) {
        const double own = total * weights[order[k]] / all;
        across[k] = std::clamp(int(std::sqrt(own / kPerCell)), kLeastAcross, kMostAcross);
        fine[k] = look_closely(wide[order[k]], first, across[k]);
    });
    FlareKnowledge known;
    for (std::size_t i = 0; i < wide.size(); ++i) known.cells_of_pair.push_back(wide[i].probe.source);
    for (const FlareRectangle& front : front_) known.cells.push_back(FlareCells::evenly(front));
    const FlareTiles tiles = tiles_of(fine);
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (fine[k].hits.empty()) continue;
        const FlareWeights own(fine[k], tiles, across[k]);
        weights[order[k]] = own.sum;
        known.cells_of_pair[order[k]] = int(known.cells.size());
        known.cells.push_back(cells_of(wide[order[k]], fine[k], own));
    }
    known.pairs = choice(std::move(weights));
    return known;
}

double Learner::count(const Rays& rays) const {
    return std::clamp(rays.per_pixel * aim_.sensor().width * aim_.sensor().height, rays.least, rays.most);
}

/// Share of all rays for a ghost of a source, in proportion to the light of the source.
double Learner::share_of_pair(int source) const {
    return all_strength_ > 0 ? strength_[source] / all_strength_ / ghosts() : 0;
}

/// Rectangle where light of a source enters, for any ghost.
FlareRectangle Learner::scout(int source) const {
    const int count = std::clamp(int(kScouts * share_of_pair(source)), kFewestScouts, kMostScouts);
    FlareFound all{{source, 0, 0}};
    for (int g = 0; g < ghosts(); ++g) all.add(probe_flare(aim_, {source, g, count}));
    return all.hits.empty() ? FlareRectangle{} : all.narrowed();
}

/// Searches a ghost that is visible only through a tiny part of the front, around the ray that came nearest to the
/// frame.
FlareFound Learner::search(FlareFound found) const {
    for (int i = 0; i < kZooms && found.hits.empty() && std::isfinite(found.near_px); ++i) {
        const FlareRectangle& old = found.probe.where;
        const Vec2f half = old.size * (1.5f / std::sqrt(float(found.probe.count)));
        const Vec2f low = found.near_at - half;
        found = probe_flare(aim_, {found.probe.source, found.probe.ghost, kZoomRays, {low, half * 2}});
    }
    return found;
}

/// Probes every pair.
std::vector<FlareFound> Learner::look_wide() {
    parallel_tasks(threads_, sources(), [&](std::int64_t s) {
        visible_[s] = aim_.visible_share(int(s)), strength_[s] = aim_.sources().strength(int(s)) * visible_[s];
    });
    for (int s = 0; s < sources(); ++s)
        if (!leaves_source(s)) all_strength_ += strength_[s];
    parallel_tasks(threads_, sources(), [&](std::int64_t s) {
        if (!leaves_source(int(s))) front_[s] = scout(int(s));
    });
    const double total = count(kWide);
    std::vector<FlareFound> found(strength_.size() * std::size_t(ghosts()));
    parallel_tasks(threads_, std::int64_t(found.size()), [&](std::int64_t i) {
        if (leaves(std::size_t(i))) return;
        const int source = int(i / ghosts()), own = int(total * share_of_pair(source));
        const int count = std::clamp(own / 8 * 8, kFewest, kMost);
        found[i] = probe_flare(aim_, {source, int(i % ghosts()), count, front_[source]});
        if (count >= kSearched) found[i] = search(std::move(found[i]));
    });
    return found;
}

FlareTiles Learner::tiles_of(const std::vector<FlareFound>& found) const {
    FlareTiles tiles(aim_.sensor());
    for (const FlareFound& f : found)
        for (const FlareFound::Hit& hit : f.hits)
            tiles.add(hit.px, visible_[f.probe.source] * hit.luminance * hit.share);
    tiles.finish();
    return tiles;
}

/// Pairs to probe again, by decreasing weight.
std::vector<std::size_t> Learner::order_of(const std::vector<double>& weights) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] > 0) order.push_back(i);
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return weights[i]; });
    order.resize(std::min(order.size(), kMostPairs));
    return order;
}

/// Rectangle where light enters, narrowed as long as it is less than half of the probed rectangle.
FlareRectangle Learner::narrow(const FlareFound& wide) const {
    FlareProbe probe{wide.probe.source, wide.probe.ghost, kLook, wide.narrowed()};
    for (int i = 0; i < 2; ++i) {
        FlareFound closer = probe_flare(aim_, probe);
        if (closer.hits.empty()) break;
        closer.reach(wide);
        const FlareRectangle next = closer.narrowed();
        const bool done = next.area() > 0.5f * probe.where.area();
        probe.where = next;
        if (done) break;
    }
    return probe.where;
}

/// Probes a larger rectangle as long as light enters at the edge of the probed rectangle: light beyond it would be left
/// to the few defensive paths, and each would be a firefly.
FlareFound Learner::look_closely(const FlareFound& wide, const FlareTiles& tiles, int across) const {
    FlareRectangle where = narrow(wide);
    for (int i = 0;; ++i) {
        FlareFound found = look_into({wide.probe.source, wide.probe.ghost, 0, where}, tiles, across);
        const FlareRectangle grown = found.grown(across);
        if (i == kGrowths || grown.area() <= where.area()) return found;
        where = grown;
    }
}

/// Probes in rounds, to follow thin rings of light from random first hits.
FlareFound Learner::look_into(const FlareProbe& what, const FlareTiles& tiles, int across) const {
    FlareFound found{what};
    std::vector<double> rays(std::size_t(across) * across);
    const int total = kPerCell * int(rays.size());
    for (int round = 0; round < kRounds; ++round) {
        const int count = total / kRounds;
        const FlareWeights weights(found, tiles, across, 2);
        const bool known = !found.hits.empty();
        const Distribution2D cells = known ? Distribution2D(across, across, weights.cells) : Distribution2D();
        FlareProbe probe = found.probe;
        probe.first = found.probe.count, probe.count = count, probe.cells = known ? &cells : nullptr;
        found.add(probe_flare(aim_, probe));
        const double all = std::accumulate(weights.cells.begin(), weights.cells.end(), 0.0);
        for (std::size_t i = 0; i < rays.size(); ++i)
            rays[i] += count * (known ? weights.cells[i] / all : 1 / double(rays.size()));
        found.share(rays, across);
    }
    return found;
}

FlareCells Learner::cells_of(const FlareFound& wide, const FlareFound& fine, const FlareWeights& weights) const {
    FlareCells cells;
    cells.inner = fine.probe.where, cells.outer = wide.narrowed(), cells.front = front_[wide.probe.source];
    cells.weights = Distribution2D(weights.across, weights.across, weights.cells);
    cells.wavelengths = DiscreteDistribution(std::span<const double>(weights.wavelengths));
    cells.blind = std::clamp(kFewHits / float(fine.hits.size()), kBlindCell, 0.5f);
    return cells;
}

/// Weights of pairs without learning: strength of the source times reflectances at normal incidence.
std::vector<double> Learner::blind() const {
    std::vector<double> weights;
    for (int s = 0; s < sources(); ++s)
        for (int g = 0; g < ghosts(); ++g) {
            const double own = aim_.sources().strength(s) * aim_.reflectance(g);
            weights.push_back(leaves(weights.size()) ? 0 : own);
        }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights) w /= sum > 0 ? sum : 1;
    return weights;
}

/// Mixes in the mean ghost weights of all sources, as dim sources have been probed with few rays.
void Learner::pool(std::vector<double>& weights) const {
    std::vector<double> of_ghost(ghosts());
    double all = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) of_ghost[i % ghosts()] += weights[i], all += weights[i];
    if (!(all > 0)) return;
    for (int s = 0; s < sources(); ++s) {
        double* own = weights.data() + std::size_t(s) * ghosts();
        const double sum = std::accumulate(own, own + ghosts(), 0.0);
        for (int g = 0; g < ghosts(); ++g)
            if (!leaves(std::size_t(s) * ghosts() + g))
                own[g] = (1 - kPooled) * own[g] + kPooled * sum * of_ghost[g] / all;
    }
}

/// Distribution of pairs with a defensive share. Occluded sources and expensive paths have lower weights.
DiscreteDistribution Learner::choice(std::vector<double> weights) const {
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const int source = int(i) / ghosts();
        weights[i] *= std::sqrt(visible_[source]) * (aim_.sources().reflected(source) ? kReflected : 1);
    }
    pool(weights);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<double> even = blind();
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = sum > 0 ? (1 - kBlindPair) * weights[i] / sum + kBlindPair * even[i] : even[i];
    return DiscreteDistribution(std::span<const double>(weights));
}

}  // namespace

FlareKnowledge learn_flare(const FlareAim& aim, int threads, const std::vector<bool>& mapped) {
    const bool all_mapped = aim.ghosts() == aim.pairs() && int(mapped.size()) == aim.sources().count() &&
                            std::ranges::all_of(mapped, std::identity{});
    if (aim.ghosts() == 0 || aim.sources().count() == 0 || all_mapped) return {};
    return Learner(aim, threads, mapped).learn();
}

FlareKnowledge naive_flare(const FlareAim& aim) {
    FlareKnowledge known;
    const std::vector<double> weights(std::size_t(aim.sources().count()) * aim.ghosts(), 1.0);
    if (weights.empty()) return known;
    known.pairs = DiscreteDistribution(std::span<const double>(weights));
    known.cells_of_pair.assign(weights.size(), 0);
    known.cells.push_back(FlareCells::evenly({}));
    return known;
}

}  // namespace dg
