#include "render/flare/live/live_ghost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/thread_scratch.h"
#include "render/flare/live/node_fill.h"
#include "render/flare/live/spread_numbers.h"
#include "render/flare/maps/coarse_light.h"

namespace dg {
namespace {

constexpr int kLooks = 8;               // samples per square
constexpr float kUnseen = 0.3f;         // pseudo-count of lit samples, for squares without any
constexpr float kLostUnseen = 0.25f;    // pseudo-count where rays are lost
constexpr float kLostMore = 1.2f;       // factor on arrivals where rays are lost, as samples are less reliable
constexpr double kWorthMore = 1500, kWorthMost = 6000;   // arrivals of a ghost that justify more colour nodes
constexpr double kWorthFine = 18;       // arrivals of a square that justify a finer grid
constexpr double kWorthWays = 50;       // arrivals that justify a finer grid where rays are lost
constexpr double kWorthRays = 40;       // arrivals of a steep square that justify exact rays
constexpr float kSteep = 0.2f;          // range of a steep transmittance, relative to its mean
constexpr float kBend = 0.7f;           // px: deviation from linear between nodes that justifies a finer grid
constexpr int kGlassNodes = 4;          // nodes at which transmittances are evaluated
constexpr float kAlmost = 0.1f;         // clip value up to which neighbouring points may be lit
constexpr int kWaves = LiveSource::kNodes;

/// Fields of all nodes, field by field.
std::vector<float> planes_of(const std::vector<MapLanding>& nodes, int crossings) {
    const int count = int(nodes.size());
    std::vector<float> planes(std::size_t(MeshPatch::fields(crossings)) * count);
    for (int n = 0; n < count; ++n) {
        put_fields(planes.data() + n, count, nodes[n], crossings);
        planes[std::size_t(MeshPatch::pass_field(crossings)) * count + n] = nodes[n].pass;
    }
    return planes;
}

}  // namespace

LiveGhost::LiveGhost(const MapRays& rays, const LiveSource& source, const Sensor& sensor, std::uint64_t key,
                     const KnownGhost* known)
    : rays_(rays), source_(source), sensor_(sensor), known_(known), first_(std::uint32_t(hash64(key))),
      grid_(rays, sensor, CoarseLight::reach(LightLayer::kLevels - 1), known) {
    traced_ = grid_.rays;
    if (grid_.empty()) return;
    std::vector<MapLanding> nodes = grid_.nodes;
    fill_landings(nodes, kSide);
    planes_ = planes_of(nodes, rays_.crossings());
    look_around();
}

void LiveGhost::look_around() {
    MapBatch& batch = thread_scratch<MapBatch>([] {});
    for (int i = 0; i < kLooks; ++i) {
        const SpreadNumbers u{std::uint32_t(i + 1)};
        batch.set(i, {u[0], u[1]}, {0, 0}, GhostGrid::middle_nm(), 1);
    }
    const GhostPlace::Spectrum glass = this->glass();
    const float light = source_.light_of(glass);
    if (!(light > 0)) return;
    const GlassChange change = source_.change(glass);
    float most = 0;
    for (int i = 0; i < int(grid_.lit.size()); ++i) {
        if (!grid_.lit[i]) continue;
        squares_.push_back({i % GhostGrid::kSquares, i / GhostGrid::kSquares});
        look(squares_.back(), batch, change);
        squares_.back().light *= light, squares_.back().root *= light;
        most = std::max(most, squares_.back().light);
    }
    if (!(most > 0)) squares_.clear();
}

/// Approximate mean of its spectra, from lit nodes.
GhostPlace::Spectrum LiveGhost::glass() {
    std::vector<int> open;
    for (int n = 0; n < kNodes; ++n)
        if (grid_.nodes[n].sound && rays_.stopped(grid_.nodes[n]) < 0) open.push_back(n);
    if (open.empty())
        for (int n = 0; n < kNodes; ++n)
            if (grid_.nodes[n].sound && grid_.nodes[n].beyond < kAlmost) open.push_back(n);
    if (open.empty()) return {};
    std::vector<int> some;
    for (int i = 0; i < kGlassNodes; ++i) some.push_back(open[(2 * std::size_t(i) + 1) * open.size() / (2 * kGlassNodes)]);
    GhostPlace::Spectrum mean{};
    for (const GhostPlace::Spectrum& s : spectra(some))
        for (int k = 0; k < kWaves; ++k) mean[k] += s[k] / kGlassNodes;
    return mean;
}

/// Samples a square from the grid alone, for a monochromatic point source with the mean of its spectra.
void LiveGhost::look(Square& s, MapBatch& b, const GlassChange& glass) {
    MeshPatch p = patch(s);
    p.glass = glass;
    p.land(rays_.ghosts().tables().iris, b, kLooks);
    int seen = 0;
    Vec2f px{0, 0};
    const float reach = CoarseLight::reach(LightLayer::kLevels - 1);
    for (int i = 0; i < kLooks; ++i) {
        px = px + Vec2f{b.x[i], b.y[i]} * (1.f / kLooks);
        const bool near = b.x[i] > -reach && b.y[i] > -reach && b.x[i] < float(sensor_.width) + reach &&
                          b.y[i] < float(sensor_.height) + reach;
        if (!near || !(b.left[i] > 0)) continue;
        ++seen, s.light += b.left[i] / kLooks, s.root += b.left[i] * b.left[i] / kLooks;
    }
    s.px = px, s.edge = seen < kLooks;
    for (int k = 0; k < 4; ++k) s.lost |= !node(s.x + (k & 1), s.y + (k >> 1)).sound;
    if (seen == 0) s.light = 0;
    s.root = std::sqrt(s.root);
}

void LiveGhost::add_to(FlareTiles& tiles) const {
    const double area = source_.light * grid_.region.area() / (GhostGrid::kSquares * GhostGrid::kSquares);
    for (const Square& s : squares_)
        if (sensor_.holds(s.px)) tiles.add(s.px, area * s.light);
}

double LiveGhost::weigh(const FlareTiles& tiles) {
    const double area = source_.light * grid_.region.area() / (GhostGrid::kSquares * GhostGrid::kSquares);
    float most = 0;
    for (const Square& s : squares_) most = std::max(most, s.light);
    double sum = 0;
    for (Square& s : squares_) {
        const float unseen = s.lost ? kLostUnseen : s.light > 0 ? 0 : kUnseen;
        const float light = std::max(s.root, most * unseen / kLooks);
        s.worth = (s.lost ? kLostMore : 1) * area * light * tiles.importance(s.px), sum += s.worth;
    }
    return sum;
}

double LiveGhost::steep_worth() const {
    double sum = 0;
    for (const Square& s : squares_) sum += is_steep(s) ? s.worth : 0;
    return sum;
}

/// Chooses the density of colour nodes by the number of arrivals.
void LiveGhost::divide(double own_arrivals) {
    step_ = own_arrivals > kWorthMost ? 1 : own_arrivals > kWorthMore ? 2 : 4, few_side_ = GhostGrid::kSquares / step_ + 1;
    few_.resize(std::size_t(few_side_) * few_side_);
}

GhostPlace LiveGhost::place(double arrivals, double share) {
    divide(share * arrivals);
    const FewNodes nodes = few_nodes();
    set_spectra(nodes);
    fill_few(nodes);
    GhostPlace place{grid_.region, share, few_side_, {}};
    for (const Few& f : few_) place.spectra.push_back(f.spectrum);
    return place;
}

void LiveGhost::refine(double arrivals) {
    double all = 0;
    for (const Square& s : squares_) all += s.worth;
    divide(all * arrivals);
    const FewNodes nodes = few_nodes();
    trace_sets(nodes), set_spectra(nodes);
    fill_few(nodes);
    find_blur();
    for (Square& s : squares_) {
        s.worth *= arrivals;
        s.steep = s.worth > kWorthRays && is_steep(s);
        const bool finer = s.lost ? s.worth > kWorthWays : s.worth > kWorthFine && (s.edge || bends(s));
        if (finer && (s.lost || !s.steep)) refine(s);
    }
}

/// Whether landings in a square are not linear between nodes.
bool LiveGhost::bends(const Square& s) const {
    const auto off = [&](int x, int y, int dx, int dy) {
        if (x < dx || y < dy || x + dx >= kSide || y + dy >= kSide) return 0.f;
        const MapLanding &a = node(x - dx, y - dy), &b = node(x, y), &c = node(x + dx, y + dy);
        return a.sound && b.sound && c.sound ? length(a.px - 2 * b.px + c.px) / 8 : 0.f;
    };
    float most = 0;
    for (int k = 0; k < 4; ++k) {
        const int x = s.x + (k & 1), y = s.y + (k >> 1);
        most = std::max({most, off(x, y, 1, 0), off(x, y, 0, 1)});
    }
    return most > kBend;
}

/// Whether transmittance varies too much across the square for linear interpolation.
bool LiveGhost::is_steep(const Square& s) const {
    float least = std::numeric_limits<float>::infinity(), most = 0, sum = 0;
    int count = 0;
    for (int k = 0; k < 4; ++k) {
        const MapLanding& l = node(s.x + (k & 1), s.y + (k >> 1));
        if (l.sound) least = std::min(least, l.pass), most = std::max(most, l.pass), sum += l.pass, ++count;
    }
    return count > 0 && (most - least) * float(count) > kSteep * sum;
}

void LiveGhost::refine(Square& s) {
    std::vector<MapRay> rays;
    for (int n = 0; n < kSubNodes; ++n)
        rays.push_back({grid_.at({float(s.x) + float(n % kSubSide) / kSub, float(s.y) + float(n / kSubSide) / kSub}),
                        {0, 0}, GhostGrid::middle_nm()});
    std::vector<MapLanding> nodes = trace(rays);
    if (s.lost) s.ways = int(ways_.size()), ways_.push_back(ways_of(nodes));
    if (std::ranges::none_of(nodes, [](const MapLanding& l) { return l.sound; })) {
        if (!s.lost) s.worth = 0;
        return;
    }
    fill_landings(nodes, kSubSide);
    s.fine = int(fine_.size());
    const std::vector<float> planes = planes_of(nodes, rays_.crossings());
    fine_.insert(fine_.end(), planes.begin(), planes.end());
}

/// Methods for the squares of a finer grid: exact rays where a ray at a corner is lost.
LiveGhost::Ways LiveGhost::ways_of(const std::vector<MapLanding>& nodes) const {
    const float reach = CoarseLight::reach(LightLayer::kLevels - 1);
    Ways ways;
    for (int i = 0; i < kSub * kSub; ++i) {
        const MapLanding* const at = &nodes[std::size_t(i / kSub * kSubSide + i % kSub)];
        const bool sound = at[0].sound && at[1].sound && at[kSubSide].sound && at[kSubSide + 1].sound;
        ways[i] = GhostGrid::is_dark(rays_, sensor_, reach, at, kSubSide) ? Way::dark : sound ? Way::mesh : Way::ray;
    }
    return ways;
}

MeshPatch LiveGhost::patch(const Square& s) const {
    MeshPatch p;
    p.crossings = rays_.crossings();
    if (s.fine >= 0)
        p.nodes = &fine_[s.fine], p.plane = kSubNodes, p.row = kSubSide, p.squares = kSub;
    else
        p.nodes = &planes_[std::size_t(s.y) * kSide + s.x], p.plane = kNodes, p.row = kSide;
    return p;
}

}  // namespace dg
