// light_split.cpp -- the surface area orientation heuristic. Source: Conty Estevez and
// Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting,
// section 4.4, with the squared radius of a group in place of its surface area, as in the
// tree's estimate.
#include "light/light_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dg {
namespace {

constexpr int kBins = 12;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Limit of lights that are evaluated to find a split.
constexpr std::size_t kLooks = 2048;

Vec3f component_min(Vec3f a, Vec3f b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3f component_max(Vec3f a, Vec3f b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Smallest cone around two cones of directions; sets axis and spread of `out`.
void merge_cones(const LightBounds& a, const LightBounds& b, LightBounds& out) {
    const LightBounds& wide = a.spread >= b.spread ? a : b;
    const LightBounds& narrow = a.spread >= b.spread ? b : a;
    out.axis = wide.axis;
    out.spread = wide.spread;
    if (wide.spread >= kPi) return;
    const float between = acos(std::clamp(dot(wide.axis, narrow.axis), -1.f, 1.f));
    if (std::min(between + narrow.spread, kPi) <= wide.spread) return;
    out.spread = (wide.spread + between + narrow.spread) / 2;
    const Vec3f side = narrow.axis - wide.axis * dot(narrow.axis, wide.axis);
    if (out.spread >= kPi || length(side) < 1e-6f) {
        out.spread = kPi;
        return;
    }
    const float turn = out.spread - wide.spread;
    out.axis = normalize(wide.axis * std::cos(turn) + normalize(side) * std::sin(turn));
}

Vec3f twice_center(const LightBounds& b) {
    return b.min + b.max;
}

struct Cut {
    float cost = kInfinity;
    int axis = 0, bin = 0;  // last bin of the first group
};

/// Bins of box centers along the axes.
struct Grid {
    Vec3f low, high;   // bounds of twice the centers

    int bin(const LightBounds& b, int axis) const {
        const float x = (twice_center(b)[axis] - low[axis]) / (high[axis] - low[axis]) * kBins;
        return x > 0 ? static_cast<int>(std::min(x, float(kBins - 1))) : 0;   // 0 for NaN by overflow
    }
};

/// Sums over the lights of bins.
struct Bin {
    Vec3f min{kInfinity, kInfinity, kInfinity}, max = -min;
    Vec3f heading;   // sum of LightItem::heading
    float intensity = 0;
    bool two_sided = false;

    void add(const LightItem& item) {
        const LightBounds& b = item.bounds;
        add({b.min, b.max, item.heading, b.intensity, b.two_sided});
    }
    void add(const Bin& b) {
        min = component_min(min, b.min);
        max = component_max(max, b.max);
        heading = heading + b.heading;
        intensity += b.intensity;
        two_sided |= b.two_sided;
    }
    bool empty() const { return intensity == 0; }
    /// Cosine-weighted solid angle of emission: pi for equal normals, 4 pi for normals in all directions. Otherwise
    /// within 7 % of the integral over a cap of normals with the mean heading / intensity.
    float orientation_measure() const {
        const float r2 = length_squared(heading) / (intensity * intensity);
        const float one_side = kPi * (4 - 3 * r2 * r2);
        return std::min(two_sided ? 2 * one_side : one_side, 4 * kPi);
    }
    float cost() const { return intensity * orientation_measure() * length_squared(max - min); }
};
using BinRow = std::array<Bin, kBins>;

/// The cheapest split along an axis. Empty bins do not change the groups.
Cut best_cut(const BinRow& bins, int axis) {
    std::array<float, kBins> above{};  // cost of all bins beyond
    Bin all;
    for (int b = kBins - 1; b > 0; --b) {
        above[b - 1] = above[b];
        if (bins[b].empty()) continue;
        all.add(bins[b]);
        above[b - 1] = all.cost();
    }
    Cut best{.axis = axis};
    all = {};
    for (int b = 0; b < kBins - 1; ++b) {
        if (bins[b].empty()) continue;
        all.add(bins[b]);
        if (const float sum = all.cost() + above[b]; sum < best.cost) best = {sum, axis, b};
    }
    return best;
}

/// The cheapest split over all axes.
Cut best_cut(std::span<const LightItem> lights, const Grid& grid) {
    std::array<BinRow, 3> bins;
    const Vec3f size = grid.high - grid.low;
    const std::size_t step = (lights.size() + kLooks - 1) / kLooks;
    for (std::size_t i = 0; i < lights.size(); i += step)
        for (int axis = 0; axis < 3; ++axis)
            if (size[axis] > 0) bins[axis][grid.bin(lights[i].bounds, axis)].add(lights[i]);
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > 0)) continue;
        Cut cut = best_cut(bins[axis], axis);
        cut.cost *= max_component(size) / size[axis];  // avoids thin slices
        if (cut.cost < best.cost) best = cut;
    }
    return best;
}

/// Splits at the median along the longest side of the centers' box.
std::size_t halve_lights(std::span<LightItem> lights, const Grid& grid) {
    const Vec3f size = grid.high - grid.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = lights.size() / 2;
    std::nth_element(lights.begin(), lights.begin() + std::ptrdiff_t(half), lights.end(),
                     [&](const LightItem& a, const LightItem& b) {
                         const float ca = twice_center(a.bounds)[axis], cb = twice_center(b.bounds)[axis];
                         return ca != cb ? ca < cb : a.light < b.light;  // the same order on every platform
                     });
    return half;
}

/// Stable partition into the two groups.
template <typename IsFirst>
std::size_t part(std::span<LightItem> lights, std::span<LightItem> room, const IsFirst& is_first) {
    std::size_t first = 0, second = 0;
    for (const LightItem& item : lights) {
        const bool front = is_first(item);
        (front ? lights[first] : room[second]) = item;
        ++(front ? first : second);
    }
    std::ranges::copy(room.first(second), lights.begin() + std::ptrdiff_t(first));
    return first;
}

}  // namespace

LightBounds merge(const LightBounds& a, const LightBounds& b) {
    LightBounds r;
    merge_cones(a, b, r);
    r.min = component_min(a.min, b.min);
    r.max = component_max(a.max, b.max);
    r.falloff = std::max(a.falloff, b.falloff);
    r.intensity = a.intensity + b.intensity;
    r.two_sided = a.two_sided || b.two_sided;
    return r;
}

LightItem::LightItem(const LightBounds& bounds, std::int32_t light)
    : bounds(bounds), heading(bounds.axis * (0.5f * bounds.intensity * (1 + std::cos(bounds.spread)))), light(light) {}

LightBounds box_of(std::span<const LightItem> lights) {
    LightBounds all = lights[0].bounds;
    for (const LightItem& item : lights.subspan(1)) {
        all.min = component_min(all.min, item.bounds.min);
        all.max = component_max(all.max, item.bounds.max);
        all.intensity += item.bounds.intensity;
    }
    return all;
}

std::size_t split_lights(std::span<LightItem> lights, std::span<LightItem> room, bool halve) {
    Grid grid{twice_center(lights[0].bounds), twice_center(lights[0].bounds)};
    for (const LightItem& item : lights) {
        grid.low = component_min(grid.low, twice_center(item.bounds));
        grid.high = component_max(grid.high, twice_center(item.bounds));
    }
    if (halve || lights.size() <= 2) return halve_lights(lights, grid);
    const Cut cut = best_cut(lights, grid);
    if (!(cut.cost < kInfinity)) return halve_lights(lights, grid);
    const std::size_t first =
        part(lights, room, [&](const LightItem& item) { return grid.bin(item.bounds, cut.axis) <= cut.bin; });
    return first == 0 || first == lights.size() ? halve_lights(lights, grid) : first;
}

}  // namespace dg
