// live_ghost_draw.cpp -- draws arrivals of a ghost's squares to a layer of light.
#include <algorithm>
#include <cmath>

#include "math/thread_scratch.h"
#include "render/flare/live/live_ghost.h"
#include "render/flare/live/spread_numbers.h"
#include "render/flare/live/wavelength_pick.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kFewest = 3;              // level of light of sparse arrivals
constexpr int kGroups = LiveSource::kGroups;
constexpr float kApart = 1;             // px: largest distance of wavelength groups that are drawn together
constexpr float kStoppedApart = 0.01f;  // largest difference of clip values of groups that are drawn together

/// Weights of the differences to the wavelength nodes on either side of the middle.
Vec2f lambda_weights(float u) {
    static const WavelengthScale scale = WavelengthScale::visible();
    const float l = float(scale(LiveSource::nm(u))) / kLambdaStep;
    return {0.5f * l * (l - 1), 0.5f * l * (l + 1)};
}

}  // namespace

/// Arrivals of a square, with their random numbers.
struct LiveGhost::Arrivals {
    int count = 0;
    std::array<std::uint32_t, MapBatch::kSize> number;
    void add(std::uint32_t n) { number[std::size_t(count++)] = n; }
};

void LiveGhost::draw(LightLayer& layer, float unit) {
    const float area = grid_.region.area() / (GhostGrid::kSquares * GhostGrid::kSquares);
    const SheetLevel levels(rays_.crossings(), rays_.ghosts(), sensor_, source_.small.filled, smooth_);
    double sum = 0;
    for (const Square& s : squares_) {
        const auto first = std::uint32_t(sum), last = std::uint32_t(sum += s.worth);
        const float times = unit * area / float(s.worth);
        for (std::uint32_t from = first; from < last; from += MapBatch::kSize) {
            Arrivals mesh, rays;
            for (std::uint32_t n = from; n < std::min(last, from + MapBatch::kSize); ++n) {
                const SpreadNumbers u{first_ + n};
                const Way way = this->way(s, {u[0], u[1]});
                if (way != Way::dark) (way == Way::mesh ? mesh : rays).add(u.i);
            }
            if (mesh.count > 0) draw_mesh(layer, levels, s, mesh, times);
            if (rays.count > 0) draw_rays(layer, levels, s, rays, times);
        }
        arrived_ += last - first;
    }
}

/// Method for an arrival at a point of a square, [0, 1)^2.
LiveGhost::Way LiveGhost::way(const Square& s, Vec2f at) const {
    const Way all = s.lost || s.steep ? Way::ray : Way::mesh;
    if (s.ways < 0) return all;
    const Way own = ways_[std::size_t(s.ways)][std::size_t(int(at.y * kSub) * kSub + int(at.x * kSub))];
    return own == Way::mesh && s.steep ? Way::ray : own;
}

/// `place`: maps a number in [0, 1) to the position of the wavelength.
template <typename Place>
void LiveGhost::set(MapBatch& b, const Arrivals& some, const Place& place) const {
    const auto points = std::uint32_t(source_.small.points.size());
    for (int i = 0; i < some.count; ++i) {
        const SpreadNumbers u{some.number[std::size_t(i)]};
        const SmallSource::Point& point = source_.small.points[u.i % points];
        b.set(i, {u[0], u[1]}, point.shift, LiveSource::nm(place(u[2])), point.moment.iris_opening);
    }
}

template <typename Color>
void LiveGhost::add(LightLayer& layer, const SheetLevel& levels, const Square& s, const MapBatch& b, const Arrivals& some,
                    const Color& color) const {
    const auto points = std::uint32_t(source_.small.points.size());
    const float least = least_level(s);
    for (int i = 0; i < some.count; ++i) {
        if (!(b.left[i] > 0)) continue;
        const SpreadNumbers u{some.number[std::size_t(i)]};
        const int level = std::min(int(std::max(levels.of(s.blur, b, i), least) + u[3]), LightLayer::kLevels - 1);
        layer.add(level, {b.x[i], b.y[i]}, color(u[2]) * (b.left[i] * source_.brightness[u.i % points]));
    }
}

/// Draws arrivals by interpolation. Where wavelengths differ in landing or clipping, each arrival is split into groups
/// of wavelengths.
void LiveGhost::draw_mesh(LightLayer& layer, const SheetLevel& levels, const Square& s, const Arrivals& some,
                          float times) const {
    MapBatch& b = thread_scratch<MapBatch>([] {});
    const Few few = few_at({float(s.x) + 0.5f, float(s.y) + 0.5f});
    const GroupColors colors = colors_of(few, times);
    MeshPatch p = patch(s);
    p.sets = few.sets, p.glass = source_.change(few.spectrum);
    const IrisTables& iris = rays_.ghosts().tables().iris;
    if (apart(s, p)) {
        for (int g = 0; g < kGroups; ++g) {
            set(b, some, [g](float u) { return (float(g) + u) / kGroups; }), p.land(iris, b, some.count);
            add(layer, levels, s, b, some, [&](float) { return colors[g]; });
        }
    } else {
        const Rgb all = colors[0] + colors[1] + colors[2];
        set(b, some, [](float) { return 0.5f; }), p.land(iris, b, some.count);
        add(layer, levels, s, b, some, [&](float) { return all; });
    }
}

/// Draws arrivals by exact rays of a single wavelength.
void LiveGhost::draw_rays(LightLayer& layer, const SheetLevel& levels, const Square& s, const Arrivals& some, float times) {
    MapBatch& b = thread_scratch<MapBatch>([] {});
    const WavelengthPick pick(few_at({float(s.x) + 0.5f, float(s.y) + 0.5f}).spectrum);
    set(b, some, [&](float u) { return pick(u).place; }), land_by_rays(s, b, some.count);
    add(layer, levels, s, b, some, [&](float u) {
        const auto picked = pick(u);
        return source_.at[std::size_t(picked.place * LiveSource::kSteps)] * (picked.weight * times * source_.free);
    });
}

LiveGhost::GroupColors LiveGhost::colors_of(const Few& few, float times) const {
    GroupColors colors{};
    for (int g = 0; g < kGroups; ++g)
        for (int k = 0; k < LiveSource::kNodes; ++k)
            colors[g] = colors[g] + source_.colors[g][k] * (few.spectrum[k] * times * source_.free);
    return colors;
}

/// Whether groups of wavelengths differ in landing or clipping.
bool LiveGhost::apart(const Square& s, const MeshPatch& p) const {
    const auto change = [&](int field) {
        static const std::array<Vec2f, 2> ends = {lambda_weights(0.5f / kGroups), lambda_weights(1 - 0.5f / kGroups)};
        const Vec2f w = ends[1] - ends[0];
        return w.x * p.sets[MeshPatch::kShort][field] + w.y * p.sets[MeshPatch::kLong][field];
    };
    if (length(Vec2f{change(0), change(1)}) > kApart) return true;
    if (!s.edge) return false;
    float most = std::abs(change(2));
    const float per_mm = 2 / float(rays_.ghosts().iris_radius());
    for (int k = 0; k < p.crossings; ++k)
        most = std::max(most, per_mm * length(Vec2f{change(3 + 2 * k), change(4 + 2 * k)}));
    return most > kStoppedApart;
}

/// Traces a ray for each arrival, as landings cannot be interpolated next to lost rays.
void LiveGhost::land_by_rays(const Square& s, MapBatch& b, int count) {
    std::vector<MapRay> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back({grid_.at({float(s.x) + b.u[i], float(s.y) + b.v[i]}), {b.shift_x[i], b.shift_y[i]}, b.nm[i]});
    const std::vector<MapLanding> landings = trace(rays);
    by_rays_ += rays.size();
    for (int i = 0; i < count; ++i) {
        const MapLanding& l = landings[std::size_t(i)];
        const float passed = rays_.passed(l, b.opening[i]);
        b.left[i] = passed;
        b.x[i] = l.px.x, b.y[i] = l.px.y, b.beyond[i] = l.beyond;
        for (int k = 0; k < rays_.crossings(); ++k)
            b.iris_x[k][i] = l.iris[std::size_t(k)].x, b.iris_y[k][i] = l.iris[std::size_t(k)].y;
    }
}

/// Level at which each node receives about one arrival of the square.
float LiveGhost::least_level(const Square& s) const {
    const MapLanding &a = node(s.x, s.y), &b = node(s.x + 1, s.y), &c = node(s.x, s.y + 1), &d = node(s.x + 1, s.y + 1);
    if (s.lost) return 0;
    const Vec2f p = d.px - a.px, q = c.px - b.px;
    const float px2 = 0.5f * std::abs(p.x * q.y - p.y * q.x);
    return std::clamp(0.5f * std::log2(std::max(px2, 1e-6f) / float(s.worth)), 0.f, float(kFewest));
}

}  // namespace dg
