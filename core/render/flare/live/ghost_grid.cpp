#include "render/flare/live/ghost_grid.h"

#include <algorithm>
#include <limits>

#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kZooms = 5;          // limit of zoom steps
constexpr int kCoarse = 8;         // squares along each axis while zooming
constexpr int kSearches = 4;       // search steps if no ray finds light
constexpr float kAbout = 2;        // radius of a search, in squares
constexpr int kHardly = 8;         // lit nodes below which positions between nodes are sampled
constexpr int kPlenty = 120;       // lit nodes above which no light is missed between nodes
constexpr float kCloseIn = 0.5f;   // lit fraction of the region below which zooming continues
constexpr float kWellSeen = 0.8f;  // limit of the lit fraction with at least kPlenty lit nodes
constexpr double kDim = 0.005;     // share of all light below which the region is not zoomed
constexpr double kFaint = 0.001;   // share of all light below which no search is made
constexpr double kFewRays = 5e-4;  // share of all light below which every other node is traced
constexpr float kMargin = 2.f / GhostGrid::kSquares;   // relative margin around a known region

struct Range {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    void add(float v) { low = std::min(low, v), high = std::max(high, v); }
    float size() const { return high - low; }
};

MapLanding mean(const MapLanding& a, const MapLanding& b) {
    MapLanding m = a.sound ? b : a;   // a lost ray keeps its position
    m.sound = a.sound && b.sound;
    m.px = 0.5f * (a.px + b.px), m.beyond = 0.5f * (a.beyond + b.beyond), m.pass = 0.5f * (a.pass + b.pass);
    for (int k = 0; k < kMostCrossings; ++k) m.iris[k] = 0.5f * (a.iris[k] + b.iris[k]);
    return m;
}

/// Nodes of a grid with twice as many squares across. Each new node is the mean of its neighbors.
std::vector<MapLanding> doubled(const std::vector<MapLanding>& nodes, int side) {
    const int fine = 2 * side - 1;
    std::vector<MapLanding> all(std::size_t(fine) * fine);
    const auto at = [&](int x, int y) -> MapLanding& { return all[std::size_t(y) * fine + x]; };
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) at(2 * x, 2 * y) = nodes[std::size_t(y) * side + x];
    for (int y = 0; y < fine; y += 2)
        for (int x = 1; x < fine; x += 2) at(x, y) = mean(at(x - 1, y), at(x + 1, y));
    for (int y = 1; y < fine; y += 2)
        for (int x = 0; x < fine; ++x) at(x, y) = mean(at(x, y - 1), at(x, y + 1));
    return all;
}

FlareRectangle widened(const FlareRectangle& r) {
    const Vec2f by = r.size * kMargin;
    const Vec2f low{std::max(r.low.x - by.x, -1.f), std::max(r.low.y - by.y, -1.f)};
    const Vec2f high{std::min(r.low.x + r.size.x + by.x, 1.f), std::min(r.low.y + r.size.y + by.y, 1.f)};
    return {low, high - low};
}

}  // namespace

bool GhostGrid::is_dark(const MapRays& rays, const Sensor& sensor, float reach, const MapLanding* at, int side) {
    Range stop, x, y;
    bool all_sound = true;
    for (const MapLanding* l : {at, at + 1, at + side, at + side + 1}) {
        stop.add(rays.stopped(*l)), all_sound &= l->sound;
        if (l->sound) x.add(l->px.x), y.add(l->px.y);
    }
    if (stop.low > 0 && stop.low > stop.size()) return true;
    const float more = reach + std::max(x.size(), y.size());
    return all_sound && (x.low - more > float(sensor.width) || x.high + more < 0 ||
                         y.low - more > float(sensor.height) || y.high + more < 0);
}

bool GhostGrid::passes(const Looks& by, const MapLanding& l) {
    const bool here = l.px.x > -by.reach && l.px.y > -by.reach && l.px.x < float(by.sensor.width) + by.reach &&
                      l.px.y < float(by.sensor.height) + by.reach;
    return l.sound && here && by.rays.stopped(l) < 0;
}

/// Distance of a ray from passing to the frame: 0 at an edge or at a side of the frame.
float GhostGrid::from_light(const Looks& by, const MapLanding& l) {
    if (!l.sound) return std::numeric_limits<float>::infinity();
    const auto beside = [&](float px, int size) { return (std::abs(px - 0.5f * float(size)) - by.reach) / float(size) - 0.5f; };
    return std::max({by.rays.stopped(l), beside(l.px.x, by.sensor.width), beside(l.px.y, by.sensor.height)});
}

/// Marks squares near lit nodes; with few lit nodes, samples positions between nodes, too. Without any light, marks all
/// squares that are not dark.
int GhostGrid::mark(const Looks& by) {
    const int side = squares + 1, reach = squares / kCoarse;
    std::vector<bool> may(squares * squares), near(squares * squares);
    int seen = 0;
    const auto see = [&](int x, int y) {
        ++seen;
        for (int v = std::max(y - reach, 0); v < std::min(y + reach, squares); ++v)
            for (int u = std::max(x - reach, 0); u < std::min(x + reach, squares); ++u) near[v * squares + u] = true;
    };
    for (int i = 0; i < squares * squares; ++i)
        may[i] = !is_dark(by.rays, by.sensor, by.reach, &nodes[i / squares * side + i % squares], side);
    nearest = std::numeric_limits<float>::infinity();
    const auto note = [&](Vec2f node, const MapLanding& l) {
        if (const float far = from_light(by, l); far < nearest) nearest = far, nearest_at = node;
    };
    for (int n = 0; n < side * side; ++n) {
        if (passes(by, nodes[n])) see(n % side, n / side);
        note({float(n % side), float(n / side)}, nodes[n]);
    }
    if (seen < by.hardly) {
        std::vector<MapRay> looks;
        std::vector<int> of;
        for (int i = 0; i < squares * squares; ++i)
            for (const Vec2f u : {Vec2f{0.5f, 0}, {0, 0.5f}, {0.5f, 0.5f}})
                if (may[i])
                    of.push_back(i),
                        looks.push_back({at(Vec2f{float(i % squares), float(i / squares)} + u), {0, 0}, middle_nm()});
        const std::vector<MapLanding> landings = by.rays.trace(looks);
        rays += looks.size();
        for (std::size_t k = 0; k < looks.size(); ++k) {
            const int x = of[k] % squares, y = of[k] / squares;
            if (passes(by, landings[k])) see(x, y), see(x + 1, y + 1);
            note(region.in(looks[k].at) * float(squares), landings[k]);
        }
    }
    lit.assign(squares * squares, false);
    for (int i = 0; i < squares * squares; ++i) lit[i] = may[i] && (near[i] || seen == 0);
    return seen;
}

float GhostGrid::middle_nm() { return lambda_node(1); }

/// Traces a grid over the region, and returns the number of lit nodes.
int GhostGrid::look(const Looks& by, int across) {
    const bool few = across == kSquares && by.share < kFewRays;
    squares = few ? across / 2 : across;
    std::vector<MapRay> looks;
    const int side = squares + 1;
    for (int i = 0; i < side * side; ++i) looks.push_back({at({float(i % side), float(i / side)}), {0, 0}, middle_nm()});
    nodes = by.rays.trace(looks), rays += looks.size();
    if (few) nodes = doubled(nodes, side), squares = across;
    return mark(by);
}

/// Shrinks the region to the lit squares; false if it is not smaller, or empty.
bool GhostGrid::close_in(float least) {
    int low_x = squares, low_y = squares, high_x = 0, high_y = 0;
    for (int y = 0; y < squares; ++y)
        for (int x = 0; x < squares; ++x) {
            if (!lit[y * squares + x]) continue;
            low_x = std::min(low_x, x), high_x = std::max(high_x, x + 1);
            low_y = std::min(low_y, y), high_y = std::max(high_y, y + 1);
        }
    const int held = (high_x - low_x) * (high_y - low_y);
    if (high_x == 0 || float(held) > least * float(squares * squares)) return false;
    const Vec2f low = at({float(low_x), float(low_y)}), high = at({float(high_x), float(high_y)});
    region = {low, high - low};
    return true;
}

/// Shrinks the region to the surroundings of the ray that came nearest to the frame, as light may enter through a tiny
/// part; false if all is dark.
bool GhostGrid::search() {
    if (std::ranges::find(lit, true) == lit.end() || !(nearest < std::numeric_limits<float>::infinity())) return false;
    const auto end = float(squares);
    const Vec2f low{std::clamp(nearest_at.x - kAbout, 0.f, end), std::clamp(nearest_at.y - kAbout, 0.f, end)};
    const Vec2f high{std::clamp(nearest_at.x + kAbout, 0.f, end), std::clamp(nearest_at.y + kAbout, 0.f, end)};
    const Vec2f from = at(low), to = at(high);
    region = {from, to - from};
    return true;
}

/// Whether no ray is lost in lit squares.
bool GhostGrid::is_smooth() const {
    const int side = squares + 1;
    for (int i = 0; i < squares * squares; ++i)
        for (int k = 0; k < 4 && lit[i]; ++k)
            if (!nodes[(i / squares + (k >> 1)) * side + i % squares + (k & 1)].sound) return false;
    return true;
}

/// Whether light enters at a side of the region inside the front, so that the region may be too small.
bool GhostGrid::is_cut(const Looks& by) const {
    const int side = squares + 1;
    const Vec2f low = region.low, high = region.low + region.size;
    const auto lit_at = [&](auto node) {
        for (int k = 0; k < side; ++k)
            if (passes(by, nodes[node(k)])) return true;
        return false;
    };
    return (low.x > -1 && lit_at([&](int k) { return k * side; })) ||
           (high.x < 1 && lit_at([&](int k) { return k * side + squares; })) ||
           (low.y > -1 && lit_at([&](int k) { return k; })) ||
           (high.y < 1 && lit_at([&](int k) { return squares * side + k; }));
}

/// Zooms in on the light from the whole front; returns the number of lit nodes.
int GhostGrid::find(const Looks& by) {
    region = {};
    int seen = look(by, kSquares);
    for (int n = 0; seen == 0 && n < kSearches && search(); ++n) seen = look(by, kCoarse);
    if (seen == 0) {
        nodes.clear();
        return 0;
    }
    for (int zoom = 1; zoom < kZooms && seen >= by.hardly && is_smooth() && close_in(kCloseIn); ++zoom) seen = look(by, kCoarse);
    return squares == kSquares ? seen : look(by, kSquares);
}

GhostGrid::GhostGrid(const MapRays& map_rays, const Sensor& sensor, float reach,
                     const KnownGhost* known) {
    const bool faint = known && known->share < kFaint;
    const Looks by{map_rays, sensor, reach, faint ? 1 : kHardly, known ? known->share : 1};
    int seen = 0;
    if (known) {
        region = widened(known->region), seen = look(by, kSquares);
        const bool dark = std::ranges::find(lit, true) == lit.end();
        const bool elsewhere = dark ? known->jumps() : seen < kHardly || is_cut(by);
        if (elsewhere && !faint) seen = find(by);
    } else {
        seen = find(by);
    }
    const auto least = [&] {
        if (known && known->share < kDim) return kCloseIn;
        const auto passing = std::ranges::count_if(nodes, [&](const MapLanding& l) { return l.sound && l.beyond < 0; });
        return passing > kPlenty ? kWellSeen : kCloseIn;
    };
    for (int zoom = 0; zoom < kZooms && !empty() && close_in(least()); ++zoom) seen = look(by, kSquares);
    if (seen == 0) nodes.clear();
}

}  // namespace dg
