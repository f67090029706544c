// live_ghost_draw.cpp -- arrivals of a ghost's squares, onto a layer of light.
#include <algorithm>
#include <cmath>

#include "math/thread_scratch.h"
#include "render/flare/live/live_ghost.h"
#include "render/flare/live/spread_numbers.h"

namespace dg {
namespace {

constexpr int kFewest = 3;              // level of light from few arrivals
constexpr float kApart = 1;             // px, of groups of bands that land together
constexpr int kBands = LiveSource::kBands;

}  // namespace

void LiveGhost::draw(LightLayer& layer, float unit) {
    const float area = grid_.region.area() / (GhostGrid::kSquares * GhostGrid::kSquares);
    const SheetLevel levels(rays_.crossings(), rays_.ghosts(), sensor_, source_.small.filled, smooth_);
    double sum = 0;
    for (const Square& s : squares_) {
        const auto first = std::uint32_t(sum), last = std::uint32_t(sum += s.worth);
        for (std::uint32_t from = first; from < last; from += MapBatch::kSize) {
            const auto count = int(std::min<std::uint32_t>(last - from, MapBatch::kSize));
            draw(layer, levels, s, first_ + from, count, unit * area / float(s.worth));
        }
        arrived_ += last - first;
    }
}

/// Arrivals of a square. Colours that land apart are a few groups of wavelengths, each in its place.
void LiveGhost::draw(LightLayer& layer, const SheetLevel& levels, const Square& s, std::uint32_t from, int count,
                     float times) {
    MapBatch& b = thread_scratch<MapBatch>([] {});
    const auto points = std::uint32_t(source_.small.points.size());
    for (int i = 0; i < count; ++i) {
        const SpreadNumbers u{from + std::uint32_t(i)};
        const SmallSource::Point& point = source_.small.points[u.i % points];
        b.set(i, {u[0], u[1]}, point.shift, GhostGrid::middle_nm(), point.moment.iris_opening);
    }
    const Few few = few_at({float(s.x) + 0.5f, float(s.y) + 0.5f});
    MeshPatch p = patch(s);
    p.sets = few.sets;
    s.lost ? land_by_rays(s, b, count) : p.land(rays_.ghosts().tables().iris, b, count);
    const float least = least_level(s);
    constexpr int kGroups = LiveSource::kGroups, kOfGroup = kBands / kGroups;
    std::array<Rgb, kGroups> colors{};
    for (int k = 0; k < kBands; ++k)
        colors[k / kOfGroup] = colors[k / kOfGroup] + source_.colors[k] * (few.spectrum[k] * times * source_.free / kBands);
    const auto& weights = LiveSource::lambda_weights();
    const auto moved = [&](float u) {
        const Vec2f w = weights[std::size_t(u * float(weights.size()))];
        return Vec2f{w.x * p.sets[0][0] + w.y * p.sets[1][0], w.x * p.sets[0][1] + w.y * p.sets[1][1]};
    };
    const bool together = length(moved(0.5f / kGroups) - moved(1 - 0.5f / kGroups)) < kApart;
    const Rgb all = colors[0] + colors[1] + colors[2];
    for (int i = 0; i < count; ++i) {
        if (!(b.left[i] > 0)) continue;
        const SpreadNumbers u{from + std::uint32_t(i)};
        const float light = b.left[i] * source_.brightness[u.i % points];
        const int level = std::min(int(std::max(levels.of(s.blur, b, i), least) + u[3]), LightLayer::kLevels - 1);
        const Vec2f px{b.x[i], b.y[i]};
        if (together) {
            layer.add(level, px + moved(0.5f), all * light);
            continue;
        }
        for (int g = 0; g < kGroups; ++g) layer.add(level, px + moved((float(g) + u[2]) / kGroups), colors[g] * light);
    }
}

/// Each by a ray of its own: where some have no landing, nothing can be interpolated.
void LiveGhost::land_by_rays(const Square& s, MapBatch& b, int count) {
    std::vector<MapRay> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back({grid_.at({float(s.x) + b.u[i], float(s.y) + b.v[i]}), {b.shift_x[i], b.shift_y[i]}, b.nm[i]});
    const std::vector<MapLanding> landings = trace(rays);
    for (int i = 0; i < count; ++i) {
        const MapLanding& l = landings[std::size_t(i)];
        const float passed = rays_.passed(l, b.opening[i]);
        b.left[i] = passed > 0 ? passed / l.pass : 0;
        b.x[i] = l.px.x, b.y[i] = l.px.y, b.beyond[i] = l.beyond;
        for (int k = 0; k < rays_.crossings(); ++k)
            b.iris_x[k][i] = l.iris[std::size_t(k)].x, b.iris_y[k][i] = l.iris[std::size_t(k)].y;
    }
}

/// At which a node gets an arrival of the square, about.
float LiveGhost::least_level(const Square& s) const {
    const MapLanding &a = node(s.x, s.y), &b = node(s.x + 1, s.y), &c = node(s.x, s.y + 1), &d = node(s.x + 1, s.y + 1);
    if (s.lost) return 0;
    const Vec2f p = d.px - a.px, q = c.px - b.px;
    const float px2 = 0.5f * std::abs(p.x * q.y - p.y * q.x);
    return std::clamp(0.5f * std::log2(std::max(px2, 1e-6f) / float(s.worth)), 0.f, float(kFewest));
}

}  // namespace dg
