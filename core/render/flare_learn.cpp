#include "render/flare_learn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/parallel.h"

namespace dg {
namespace {

constexpr float kBlindPair = 0.02f;   // share of paths whose source and ghost are not learned
constexpr float kBlindCell = 0.02f;   // and whose place on the front is not, at least
constexpr double kProbes = 1 << 20;   // rays of the first look, all pairs together
constexpr int kFewest = 32, kMost = 1024;  // of one pair
constexpr double kPooled = 0.1;       // share of a source's paths that goes to ghosts as those of all sources do
constexpr double kKnown = 0.998;      // of the light: pairs that bring it are looked at again
constexpr std::size_t kMostPairs = 4096;
constexpr int kCoarse = 16, kFine = 32;   // cells across
constexpr double kStrong = 0.003;     // of the light: such a pair gets fine cells
constexpr int kPerCell = 4;           // rays
constexpr int kLook = 256;            // rays of a look where cells should lie
constexpr double kReflected = 0.3;    // root of what a shadow ray costs, over what a path through the scene does

float luminance_of(const FlareArrival& path) {
    return path.wavelengths.to_xyz(path.radiance).y;
}

/// Rays of one pair, over a rectangle of the front.
struct Probe {
    int source, ghost;
    int count;
    FlareRectangle where{};
};

/// What they brought.
struct Found {
    double flux = 0;
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};   // of the front
    int hits = 0, count = 0;
    double sum[5] = {};            // of film points: x, y, xx, yy, xy
    std::vector<Vec2f> at{};       // hits on the front, and their light
    std::vector<float> light{};

    /// That is lit, px: the ellipse of the film points' spread, which for a disc is the disc.
    double area() const {
        if (hits < 2) return 1;
        const double n = hits, mx = sum[0] / n, my = sum[1] / n;
        const double xx = sum[2] / n - mx * mx, yy = sum[3] / n - my * my, xy = sum[4] / n - mx * my;
        return std::max(1.0, 4 * kPiD * std::sqrt(std::max(0.0, xx * yy - xy * xy)));
    }
    /// How many paths should go there: the error of a pixel, relative to what it shows, is least if paths are
    /// as dense on the film as the root of its light.
    double weight() const { return std::sqrt(flux * area()); }
};

class Learner {
  public:
    Learner(const FlareAim& aim, int threads) : aim_(aim), threads_(threads) {}
    FlareKnowledge learn();

  private:
    int ghosts() const { return aim_.ghosts(); }
    Found probe(const Probe& probe) const;
    void refine(const std::vector<Found>& found);
    void pool(std::vector<double>& weights) const;
    static FlareRectangle narrowed(const FlareRectangle& old, const Found& found);
    FlareCells cells_of(const Probe& wide, const Found& found, Found& fine) const;
    std::vector<double> blind() const;

    const FlareAim& aim_;
    int threads_;
    FlareKnowledge known_;
};

Found Learner::probe(const Probe& probe) const {
    std::vector<FlareArrival> paths;
    std::vector<CameraRay> rays;
    std::vector<float> nm;
    Found found;
    found.count = probe.count;
    const double pdf = 1 / probe.where.area();
    const auto follow = [&] {
        std::vector<Reprojection> landings(rays.size());
        std::size_t begin = 0;
        while (begin < rays.size()) {   // states of the lens, one after the other
            const std::size_t state = aim_.state_at(rays[begin].ray.time);
            std::size_t end = begin;
            while (end < rays.size() && aim_.state_at(rays[end].ray.time) == state) ++end;
            aim_.trace(state, probe.ghost, std::span(rays).subspan(begin, end - begin),
                       std::span(nm).subspan(begin, end - begin),
                       std::span(landings).subspan(begin, end - begin));
            begin = end;
        }
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto px = aim_.on_frame(landings[i], rays[i].ray.time);
            if (!px) continue;
            const FlareArrival& path = paths[i];
            const double light = landings[i].response * luminance_of(path) / path.density / probe.count;
            ++found.hits, found.flux += light;
            found.low = {std::min(found.low.x, path.at.x), std::min(found.low.y, path.at.y)};
            found.high = {std::max(found.high.x, path.at.x), std::max(found.high.y, path.at.y)};
            const double x = px->x, y = px->y;
            const double moments[5] = {x, y, x * x, y * y, x * y};
            for (int k = 0; k < 5; ++k) found.sum[k] += moments[k];
            found.at.push_back(path.at), found.light.push_back(float(light));
        }
        paths.clear(), rays.clear(), nm.clear();
    };
    const int sequence = probe.source * ghosts() + probe.ghost;
    for (int i = 0; i < probe.count; ++i) {
        PathSampler sampler(sequence, -3, std::uint32_t(i), 0);
        const CameraRandom c = sampler.camera();
        const Vec2f at = probe.where.at(c.lens);
        const FlareAim::Random u{c.film.x, c.lambda, sampler.next_2d(), aim_.shutter().draw_any(c.time)};
        auto path = aim_.aim(probe.source, probe.ghost, at, pdf, u);
        if (!path || !(luminance_of(*path) > 0)) continue;
        paths.push_back(*path), rays.push_back(path->lens);
        nm.push_back(path->wavelengths.nm[i % kWavelengths]);
        if (rays.size() == kLensBatch) follow();
    }
    follow();
    return found;
}

FlareKnowledge Learner::learn() {
    std::vector<double> strength(aim_.sources().count());
    parallel_tasks(threads_, aim_.sources().count(), [&](std::int64_t s) {
        strength[s] = aim_.sources().strength(int(s)) * aim_.visible_share(int(s));
    });
    const double all = std::accumulate(strength.begin(), strength.end(), 0.0);
    std::vector<Found> found(std::size_t(aim_.sources().count()) * ghosts());
    parallel_tasks(threads_, std::int64_t(found.size()), [&](std::int64_t i) {
        const int source = int(i / ghosts());
        const double rays = kProbes * strength[source] / all / ghosts();
        const int count = std::clamp(int(rays) / 8 * 8, kFewest, kMost);
        found[i] = probe({source, int(i % ghosts()), count});
    });
    refine(found);
    return std::move(known_);
}

/// Pairs by what is not learned: strength of the source, and reflectances straight on.
std::vector<double> Learner::blind() const {
    std::vector<double> bright, weights;
    for (int g = 0; g < ghosts(); ++g) bright.push_back(aim_.reflectance(g));
    for (int s = 0; s < aim_.sources().count(); ++s)
        for (const double r : bright) weights.push_back(aim_.sources().strength(s) * r);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights) w /= sum;
    return weights;
}

/// Looks again at what brings nearly all of the light, where it enters.
void Learner::refine(const std::vector<Found>& found) {
    std::vector<std::size_t> order;
    double flux = 0, known = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        flux += found[i].flux;
        if (found[i].hits > 0) order.push_back(i);
    }
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return found[i].flux; });
    std::size_t kept = 0;
    while (kept < order.size() && kept < kMostPairs && known < kKnown * flux) known += found[order[kept++]].flux;
    std::vector<double> weights(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) weights[i] = found[i].weight();
    known_.cells.resize(kept), known_.cells_of_pair.assign(found.size(), -1);
    std::vector<Found> fine(kept);
    parallel_tasks(threads_, std::int64_t(kept), [&](std::int64_t k) {
        const std::size_t i = order[k];
        const bool strong = found[i].flux > kStrong * flux;
        const int across = strong ? kFine : kCoarse;
        const Probe again{int(i) / ghosts(), int(i) % ghosts(), kPerCell * across * across};
        known_.cells[k] = cells_of(again, found[i], fine[k]);
    });
    for (std::size_t k = 0; k < kept; ++k) {
        if (fine[k].hits == 0) continue;
        known_.cells_of_pair[order[k]] = int(k);
        weights[order[k]] = fine[k].weight();
    }
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (aim_.sources().reflected(int(i) / ghosts())) weights[i] *= kReflected;
    pool(weights);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<double> even = blind();
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = sum > 0 ? (1 - kBlindPair) * weights[i] / sum + kBlindPair * even[i] : even[i];
    known_.pairs = DiscreteDistribution(std::span<const double>(weights));
}

/// Of a dim source few rays were looked at: which ghosts it has is known better from all sources together.
void Learner::pool(std::vector<double>& weights) const {
    std::vector<double> of_ghost(ghosts());
    double all = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) of_ghost[i % ghosts()] += weights[i], all += weights[i];
    if (!(all > 0)) return;
    for (int s = 0; s < aim_.sources().count(); ++s) {
        double* own = weights.data() + std::size_t(s) * ghosts();
        const double sum = std::accumulate(own, own + ghosts(), 0.0);
        for (int g = 0; g < ghosts(); ++g) own[g] = (1 - kPooled) * own[g] + kPooled * sum * of_ghost[g] / all;
    }
}

/// A rectangle that holds what was found to let light in, and as much around it as the rays may have missed.
FlareRectangle Learner::narrowed(const FlareRectangle& old, const Found& found) {
    const float step = 1.5f / std::sqrt(float(found.count)), more = 0.05f + 2 / float(found.hits);
    const Vec2f size = found.high - found.low, end = old.low + old.size;
    const Vec2f margin{more * size.x + step * old.size.x, more * size.y + step * old.size.y};
    const Vec2f low{std::max(old.low.x, found.low.x - margin.x), std::max(old.low.y, found.low.y - margin.y)};
    return {low,
            {std::min(end.x, found.high.x + margin.x) - low.x, std::min(end.y, found.high.y + margin.y) - low.y}};
}

/// What enters through the cells of the rectangle that lets light in.
FlareCells Learner::cells_of(const Probe& wide, const Found& found, Found& fine) const {
    FlareCells cells;
    cells.outer = narrowed({}, found);
    Probe probe{wide.source, wide.ghost, kLook, cells.outer};
    for (int i = 0; i < 2; ++i) {   // closer, while it is small in what was looked at
        const Found closer = this->probe(probe);
        if (closer.hits == 0) break;
        const FlareRectangle next = narrowed(probe.where, closer);
        const bool done = next.area() > 0.5f * probe.where.area();
        probe.where = next;
        if (done) break;
    }
    probe.count = wide.count;
    fine = this->probe(probe);
    cells.inner = probe.where;
    cells.blind = std::clamp(2 / std::sqrt(float(std::max(fine.hits, 1))), kBlindCell, 0.5f);
    const int across = int(std::lround(std::sqrt(double(probe.count) / kPerCell)));
    std::vector<float> light(std::size_t(across) * across), spread(light.size());
    for (std::size_t i = 0; i < fine.at.size(); ++i) {
        const Vec2f in = cells.inner.in(fine.at[i]);
        const int c = std::clamp(int(in.x * float(across)), 0, across - 1),
                  r = std::clamp(int(in.y * float(across)), 0, across - 1);
        light[std::size_t(r) * across + c] += fine.light[i];
    }
    // A cell whose rays all missed may be lit at its edge where its neighbours are.
    for (int r = 0; r < across; ++r)
        for (int c = 0; c < across; ++c) {
            float around = 0;
            for (int k = 0; k < 9; ++k) {
                const int y = r + k / 3 - 1, x = c + k % 3 - 1;
                if (x >= 0 && x < across && y >= 0 && y < across)
                    around += light[std::size_t(y) * across + x];
            }
            const float own = light[std::size_t(r) * across + c];
            spread[std::size_t(r) * across + c] = own + 0.02f * around;
        }
    if (fine.flux > 0) cells.weights = Distribution2D(across, across, spread);
    return cells;
}

}  // namespace

FlareKnowledge learn_flare(const FlareAim& aim, int threads) {
    if (aim.ghosts() == 0 || aim.sources().count() == 0) return {};
    return Learner(aim, threads).learn();
}

}  // namespace dg
