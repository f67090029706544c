// light_split.cpp -- the surface area orientation heuristic. Source: Conty Estevez and
// Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting,
// section 4.4; the squared radius of a group stands for its surface, as it does in the
// tree's estimate.
#include "light/light_split.h"

#include <array>

namespace dg {
namespace {

constexpr int kBins = 12;

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
    const float between = std::acos(std::clamp(dot(wide.axis, narrow.axis), -1.f, 1.f));
    if (std::min(between + narrow.spread, kPi) <= wide.spread) {
        out.spread = wide.spread;
        return;
    }
    out.spread = (wide.spread + between + narrow.spread) / 2;
    const Vec3f side = narrow.axis - wide.axis * dot(narrow.axis, wide.axis);
    if (out.spread >= kPi || length(side) < 1e-6f) {
        out.spread = kPi;
        return;
    }
    const float turn = out.spread - wide.spread;
    out.axis = normalize(wide.axis * std::cos(turn) + normalize(side) * std::sin(turn));
}

/// Solid angle into which the group shines, weakened by the cosine: the integral over a
/// cone of normals and their falloff.
float orientation_measure(const LightBounds& b) {
    const float o = b.spread, w = std::min(o + b.falloff, kPi);
    const float one_side =
        2 * kPi * (1 - std::cos(o)) + kPi / 2 *
                                          (2 * w * std::sin(o) - std::cos(o - 2 * w) -
                                           2 * o * std::sin(o) + std::cos(o));
    return std::min(b.two_sided ? 2 * one_side : one_side, 4 * kPi);
}

float cost(const LightBounds& b) {
    return b.intensity * orientation_measure(b) * length_squared(b.max - b.min);
}

Vec3f twice_center(const LightBounds& b) {
    return b.min + b.max;
}

struct Cut {
    float cost = std::numeric_limits<float>::infinity();
    int axis = 0, bin = 0;  // bins up to here are the first group
};

/// Lights by the place of their centres along the axes.
struct Bins {
    Vec3f low, high;

    int of(const LightBounds& b, int axis) const {
        const float extent = high[axis] - low[axis];
        const float x = (twice_center(b)[axis] - low[axis]) / extent * kBins;
        return std::clamp(static_cast<int>(x), 0, kBins - 1);
    }
};

/// The cheapest cut along one axis.
Cut best_cut(std::span<const LightBounds> lights, std::span<const std::int32_t> order,
             const Bins& bins, int axis) {
    std::array<LightBounds, kBins> group;
    std::array<bool, kBins> filled{};
    for (std::int32_t i : order) {
        const int b = bins.of(lights[i], axis);
        group[b] = filled[b] ? merge(group[b], lights[i]) : lights[i];
        filled[b] = true;
    }
    std::array<float, kBins> above{};  // cost of all bins beyond
    bool any = false;
    LightBounds all;
    for (int b = kBins - 1; b > 0; --b) {
        if (filled[b]) all = any ? merge(all, group[b]) : group[b];
        any = any || filled[b];
        above[b - 1] = any ? cost(all) : 0;
    }
    Cut best{.axis = axis};
    any = false;
    for (int b = 0; b < kBins - 1; ++b) {
        if (filled[b]) all = any ? merge(all, group[b]) : group[b];
        any = any || filled[b];
        const float sum = any ? cost(all) + above[b] : best.cost;
        if (sum < best.cost) best = {sum, axis, b};
    }
    return best;
}

/// At the median of the longer side of the box of centres.
std::size_t halve_lights(std::span<const LightBounds> lights,
                         std::span<std::int32_t> order, const Bins& bins) {
    const Vec3f size = bins.high - bins.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + half, order.end(),
                     [&](std::int32_t a, std::int32_t b) {
                         const float ca = twice_center(lights[a])[axis],
                                     cb = twice_center(lights[b])[axis];
                         return ca != cb ? ca < cb : a < b;  // one order on every machine
                     });
    return half;
}

}  // namespace

LightBounds merge(const LightBounds& a, const LightBounds& b) {
    LightBounds r;
    r.min = component_min(a.min, b.min);
    r.max = component_max(a.max, b.max);
    merge_cones(a, b, r);
    r.falloff = std::max(a.falloff, b.falloff);
    r.intensity = a.intensity + b.intensity;
    r.two_sided = a.two_sided || b.two_sided;
    return r;
}

std::size_t split_lights(std::span<const LightBounds> lights,
                         std::span<std::int32_t> order, bool halve) {
    Bins bins{twice_center(lights[order[0]]), twice_center(lights[order[0]])};
    for (std::int32_t i : order) {
        bins.low = component_min(bins.low, twice_center(lights[i]));
        bins.high = component_max(bins.high, twice_center(lights[i]));
    }
    if (halve || order.size() <= 2) return halve_lights(lights, order, bins);
    Cut best;
    const Vec3f size = bins.high - bins.low;
    const float longest = max_component(size);
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > 0)) continue;
        Cut cut = best_cut(lights, order, bins, axis);
        cut.cost *= longest / size[axis];  // no thin slices
        if (cut.cost < best.cost) best = cut;
    }
    const auto second =
        std::stable_partition(order.begin(), order.end(), [&](std::int32_t i) {
            return size[best.axis] > 0 && bins.of(lights[i], best.axis) <= best.bin;
        });
    const auto first = static_cast<std::size_t>(second - order.begin());
    if (first == 0 || first == order.size()) return halve_lights(lights, order, bins);
    return first;
}

}  // namespace dg
