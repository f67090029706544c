// ghost_map_judge.cpp -- decides from a few rays of a map cell whether it may send light, and whether it is smooth.
#include <algorithm>
#include <cmath>

#include "render/flare/maps/cell_blur.h"
#include "render/flare/maps/ghost_map_maker.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr float kBeyond = 1;           // clip value beyond which landings do not matter
constexpr float kHalfway = 0.7f;    // fraction of the distance between nodes: half, with a margin
constexpr float kAlone = 0.3f;      // clip value that suffices if no neighbour ends at the same surface
constexpr float kClear = 0.02f;     // clip value that suffices in small cells
constexpr int kSmall = 2, kSmallLost = 4;   // levels of small cells; where rays are lost
constexpr float kIrisOff = 2e-3f;   // tolerance, fraction of the iris radius

}  // namespace

GhostMapMaker::Verdict GhostMapMaker::judge(const MapLanding* seen, int level, CellBlur& blur) const {
    const CellRays rays{seen, seen + kSeen, map_.crossings_};
    blur = cell_blur(rays, rays_.ghosts().iris(), rays_.ghosts().iris_radius());
    if (dark(seen, level, blur)) return Verdict::dark;
    if (!std::all_of(seen, seen + kSeen, [](const MapLanding& l) { return l.sound; })) return Verdict::lost;
    return smooth(seen, blur) ? Verdict::smooth : Verdict::rough;
}

/// Whether the rays at the corners are all blocked with clip values above their differences, or all land outside the
/// frame.
bool GhostMapMaker::dark_square(const MapLanding* const (&corner)[4]) const {
    Range stop, x, y;
    bool all_sound = true;
    for (const MapLanding* l : corner) {
        stop.add(rays_.stopped(*l)), all_sound &= l->sound;
        if (l->sound) x.add(l->px.x), y.add(l->px.y);
    }
    if (stop.low > 0 && stop.low > stop.size()) return true;
    return all_sound && beside(x, y, std::max(x.size(), y.size()));
}

/// Whether the bounds of landings, extended by `more` px, are outside the frame.
bool GhostMapMaker::beside(const Range& x, const Range& y, float more) const {
    more += reach_;
    return x.low - more > float(sensor_.width) || x.high + more < 0 || y.low - more > float(sensor_.height) ||
           y.high + more < 0;
}

/// Largest difference of stopped() to neighbouring nodes with rays that end at the same surface; between surfaces it is
/// discontinuous. Below 0 if there are no such neighbours.
float GhostMapMaker::change_around(const MapLanding* nodes, int n) const {
    constexpr int side = GhostMap::kSide;
    float change = -1;
    for (int m = 0; m < GhostMap::kNodes; ++m) {
        const bool beside = std::abs(m % side - n % side) <= 1 && std::abs(m / side - n / side) <= 1;
        if (m == n || !beside || nodes[m].lost_after != nodes[n].lost_after) continue;
        change = std::max(change, std::abs(rays_.stopped(nodes[m]) - rays_.stopped(nodes[n])));
    }
    return change;
}

/// Whether light is blocked around each node, for all points of the source.
bool GhostMapMaker::surely_stopped(const MapLanding* nodes, float margin) const {
    for (int n = 0; n < GhostMap::kNodes; ++n) {
        const float change = change_around(nodes, n);
        if (!(rays_.stopped(nodes[n]) - margin > (change < 0 ? kAlone : kHalfway * change))) return false;
    }
    return true;
}

bool GhostMapMaker::dark(const MapLanding* seen, int level, const CellBlur& blur) const {
    float least = rays_.stopped(seen[0]);
    Range x, y;
    bool all_sound = true;
    for (int i = 0; i < kSeen; ++i) {
        least = std::min(least, rays_.stopped(seen[i])), all_sound &= seen[i].sound;
        if (seen[i].sound) x.add(seen[i].px.x), y.add(seen[i].px.y);
    }
    const MapLanding* const rim = seen + kSeen;
    const float middle = rays_.stopped(seen[kRimNode]);
    const float margin = hypot(rays_.stopped(rim[0]) - middle, rays_.stopped(rim[1]) - middle);   // over the source
    if (least > margin && surely_stopped(seen, margin)) return true;
    if (level >= (all_sound ? kSmall : kSmallLost) && least - margin > kClear) return true;
    return all_sound && beside(x, y, 0.5f * std::max(x.size(), y.size()) + blur.light);
}

bool GhostMapMaker::smooth(const MapLanding* seen, const CellBlur& blur) const {
    Range beyond, x, y;
    for (int i = 0; i < kSeen; ++i) {
        if (!seen[i].sound) return false;
        beyond.add(seen[i].beyond), x.add(seen[i].px.x), y.add(seen[i].px.y);
    }
    for (int t = 0; t < kTests; ++t)
        if (!agree(by_cubics(seen, kTestAt[t]), seen[GhostMap::kNodes + t], {beyond, x, y, blur, 0, 1})) return false;
    return true;
}

MapLanding GhostMapMaker::by_cubics(const MapLanding* nodes, Vec2f u) const {
    const auto wx = cubic_weights(u.x), wy = cubic_weights(u.y);
    MapLanding map{};
    map.sound = true;
    for (int n = 0; n < GhostMap::kNodes; ++n) {
        const float w = wx[n % GhostMap::kSide] * wy[n / GhostMap::kSide];
        map.px = map.px + w * nodes[n].px, map.beyond += w * nodes[n].beyond, map.pass += w * nodes[n].pass;
        for (int k = 0; k < map_.crossings_; ++k) map.iris[k] = map.iris[k] + w * nodes[n].iris[k];
    }
    return map;
}

/// Whether landing, edge and iris agree; errors of edge and iris are measured as shifts on the film.
bool GhostMapMaker::agree(const MapLanding& map, const MapLanding& ray, const Scale& of) const {
    if (rays_.stopped(map) > kBeyond && rays_.stopped(ray) > kBeyond) return true;
    if (!ray.sound) return false;
    if (!(std::abs(map.pass - ray.pass) <= accuracy_.light * (ray.pass + of.light))) return false;
    const float blur = accuracy_.of_blur * of.slack * of.blur.light;
    if (!(length(map.px - ray.px) <= std::max(accuracy_.landing_px, blur))) return false;
    const float extent = std::max(of.x.size(), of.y.size()), edge = std::max(accuracy_.edge_px, 1.5f * blur);
    if (of.beyond.holds_zero() && std::abs(map.beyond - ray.beyond) * extent > edge * of.beyond.size()) return false;
    for (int k = 0; k < map_.crossings_; ++k)
        if (length(map.iris[k] - ray.iris[k]) > kIrisOff * of.slack * float(rays_.ghosts().iris_radius())) return false;
    return true;
}

}  // namespace dg
