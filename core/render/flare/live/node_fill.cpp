#include "render/flare/live/node_fill.h"

#include <algorithm>
#include <array>

namespace dg {
namespace {

constexpr int kReach = 1;       // nodes: distance of filled nodes from nodes with a landing
constexpr float kDark = 1e3f;   // clip value of nodes farther away

MapLanding& operator+=(MapLanding& a, const MapLanding& b) {
    a.px = a.px + b.px, a.pass += b.pass;
    for (std::size_t k = 0; k < a.iris.size(); ++k) a.iris[k] = a.iris[k] + b.iris[k];
    return a;
}

MapLanding times(MapLanding l, float w) {
    l.px = w * l.px, l.pass *= w;
    for (Vec2f& i : l.iris) i = w * i;
    return l;
}

}  // namespace

void fill_landings(std::vector<MapLanding>& nodes, int side) {
    std::vector<bool> known;
    for (const MapLanding& l : nodes) known.push_back(l.sound);
    for (int round = 0; round < kReach; ++round) {
        const std::vector<bool> before = known;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                MapLanding& own = nodes[y * side + x];
                if (before[y * side + x]) continue;
                MapLanding sum{};
                float weight = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        const auto at = [&](int steps) {
                            const int u = x + steps * dx, v = y + steps * dy;
                            return u >= 0 && v >= 0 && u < side && v < side ? v * side + u : -1;
                        };
                        const int near = at(1), far = at(2);
                        if ((dx == 0 && dy == 0) || near < 0 || !before[near]) continue;
                        const bool line = far >= 0 && before[far];
                        const float w = (line ? 4.f : 1.f) * (dx == 0 || dy == 0 ? 2.f : 1.f);
                        sum += times(nodes[near], line ? 2 * w : w), weight += w;
                        if (line) sum += times(nodes[far], -w);
                    }
                if (!(weight > 0)) continue;
                sum = times(sum, 1 / weight);
                own.px = sum.px, own.iris = sum.iris, own.pass = std::max(sum.pass, 0.f);
                known[y * side + x] = true;
            }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (!known[n]) nodes[n].beyond = kDark;
}

}  // namespace dg
