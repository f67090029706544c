#include "render/flare/live/ghost_grid.h"

#include <algorithm>
#include <limits>

#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kZooms = 4;          // times that the region is closed in on
constexpr int kHardly = 8;          // nodes at which light was seen
constexpr float kCloseIn = 0.5f;   // share of the region that holds the light: less is worth another look

struct Range {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    void add(float v) { low = std::min(low, v), high = std::max(high, v); }
    float size() const { return high - low; }
};

/// Rays at its corners are all stopped, and by more than that changes from one to the next; or all beside the frame.
bool is_dark(const MapRays& rays, const Sensor& sensor, float reach, const MapLanding* at) {
    Range stop, x, y;
    bool all_sound = true;
    for (const MapLanding* l : {at, at + 1, at + GhostGrid::kSide, at + GhostGrid::kSide + 1}) {
        stop.add(rays.stopped(*l)), all_sound &= l->sound;
        if (l->sound) x.add(l->px.x), y.add(l->px.y);
    }
    if (stop.low > 0 && stop.low > stop.size()) return true;
    const float more = reach + std::max(x.size(), y.size());
    return all_sound && (x.low - more > float(sensor.width) || x.high + more < 0 ||
                         y.low - more > float(sensor.height) || y.high + more < 0);
}

}  // namespace

bool GhostGrid::passes(const Looks& by, const MapLanding& l) {
    const bool here = l.px.x > -by.reach && l.px.y > -by.reach && l.px.x < float(by.sensor.width) + by.reach &&
                      l.px.y < float(by.sensor.height) + by.reach;
    return l.sound && here && by.rays.stopped(l) < 0;
}

/// Squares within two nodes of where light was seen; where there is hardly any, also by looks between nodes.
void GhostGrid::mark(const Looks& by) {
    std::vector<bool> may(kSquares * kSquares), near(kSquares * kSquares);
    int seen = 0;
    const auto see = [&](int x, int y) {
        ++seen;
        for (int v = std::max(y - 2, 0); v < std::min(y + 2, kSquares); ++v)
            for (int u = std::max(x - 2, 0); u < std::min(x + 2, kSquares); ++u) near[v * kSquares + u] = true;
    };
    for (int i = 0; i < kSquares * kSquares; ++i)
        may[i] = !is_dark(by.rays, by.sensor, by.reach, &nodes[i / kSquares * kSide + i % kSquares]);
    for (int n = 0; n < kSide * kSide; ++n)
        if (passes(by, nodes[n])) see(n % kSide, n / kSide);
    if (seen < kHardly) {
        std::vector<MapRay> looks;
        std::vector<int> of;
        for (int i = 0; i < kSquares * kSquares; ++i)
            for (const Vec2f u : {Vec2f{0.5f, 0}, {0, 0.5f}, {0.5f, 0.5f}})
                if (may[i])
                    of.push_back(i),
                        looks.push_back({at(Vec2f{float(i % kSquares), float(i / kSquares)} + u), {0, 0}, middle_nm()});
        const std::vector<MapLanding> landings = by.rays.trace(looks);
        rays += looks.size();
        for (std::size_t k = 0; k < looks.size(); ++k)
            if (const int x = of[k] % kSquares, y = of[k] / kSquares; passes(by, landings[k])) see(x, y), see(x + 1, y + 1);
    }
    lit.assign(kSquares * kSquares, false);
    for (int i = 0; i < kSquares * kSquares; ++i) lit[i] = may[i] && near[i];
}

float GhostGrid::middle_nm() { return lambda_node(1); }

GhostGrid::GhostGrid(const MapRays& map_rays, const Sensor& sensor, float reach) {
    for (int zoom = 1;; ++zoom) {
        std::vector<MapRay> looks;
        for (int i = 0; i < kSide * kSide; ++i)
            looks.push_back({at({float(i % kSide), float(i / kSide)}), {0, 0}, middle_nm()});
        nodes = map_rays.trace(looks), rays += looks.size();
        mark({map_rays, sensor, reach});
        int low_x = kSquares, low_y = kSquares, high_x = 0, high_y = 0;
        for (int y = 0; y < kSquares; ++y)
            for (int x = 0; x < kSquares; ++x) {
                if (!lit[y * kSquares + x]) continue;
                low_x = std::min(low_x, x), high_x = std::max(high_x, x + 1);
                low_y = std::min(low_y, y), high_y = std::max(high_y, y + 1);
            }
        if (high_x == 0) {
            nodes.clear();
            return;
        }
        const int held = (high_x - low_x) * (high_y - low_y);
        if (zoom == kZooms || float(held) > kCloseIn * kSquares * kSquares) return;
        const Vec2f low = at({float(low_x), float(low_y)}), high = at({float(high_x), float(high_y)});
        region = {low, high - low};
    }
}

}  // namespace dg
