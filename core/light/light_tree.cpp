// light_tree.cpp -- building the tree of lights, and choosing from it.
#include "light/light_tree.h"

#include <array>
#include <numeric>

namespace dg {
namespace {

// The root alone knows too little when lights surround the point, so the first choice is
// made among the nodes of a cut through the tree.
constexpr std::size_t kCutSize = 8;
// Rounding must not turn a light off at the very edge of its cone.
constexpr float kCosineSlack = 1e-3f;

/// cos(max(0, a - b)) from the cosines and sines of two angles in [0, pi].
float cos_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
    return cos_a > cos_b ? 1.f : cos_a * cos_b + sin_a * sin_b;
}
float sin_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
    return cos_a > cos_b ? 0.f : sin_a * cos_b - cos_a * sin_b;
}

float sine(float cosine) {
    return std::sqrt(std::max(0.f, 1 - cosine * cosine));
}

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

}  // namespace

LightTree::LightTree(std::span<const LightBounds> lights) : leaf_of_(lights.size()) {
    if (lights.empty()) return;
    std::vector<std::int32_t> order(lights.size());
    std::iota(order.begin(), order.end(), 0);
    nodes_.reserve(2 * lights.size());
    LightBounds all;
    build(lights, order, all);
    choose_cut();
}

LightTree::Node LightTree::make_node(const LightBounds& b) {
    Node n;
    n.center = (b.min + b.max) * 0.5f;
    n.radius2 = length_squared(b.max - b.min) * 0.25f;
    n.axis = b.axis;
    n.cos_spread = std::cos(b.spread);
    n.sin_spread = sine(n.cos_spread);
    n.cos_falloff = std::cos(b.falloff);
    n.intensity = b.intensity;
    n.two_sided = b.two_sided;
    return n;
}

/// Halves at the median of the longer side of the box of centres; returns the node's
/// index.
std::int32_t LightTree::build(std::span<const LightBounds> lights,
                              std::span<std::int32_t> order, LightBounds& bounds) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    if (order.size() == 1) {
        bounds = lights[order[0]];
        nodes_[index] = make_node(bounds);
        nodes_[index].light = order[0];
        leaf_of_[order[0]] = index;
        return index;
    }
    auto center = [&](std::int32_t i) { return lights[i].min + lights[i].max; };
    Vec3f low = center(order[0]), high = low;
    for (std::int32_t i : order) {
        low = component_min(low, center(i));
        high = component_max(high, center(i));
    }
    const Vec3f size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + half, order.end(),
                     [&](std::int32_t a, std::int32_t b) {
                         const float ca = center(a)[axis], cb = center(b)[axis];
                         return ca != cb ? ca < cb : a < b;  // one order on every machine
                     });
    LightBounds left_bounds, right_bounds;
    const std::int32_t left = build(lights, order.first(half), left_bounds);
    const std::int32_t right = build(lights, order.subspan(half), right_bounds);
    bounds = merge(left_bounds, right_bounds);
    nodes_[index] = make_node(bounds);
    nodes_[index].left = left;
    nodes_[index].right = right;
    nodes_[left].parent = nodes_[right].parent = index;
    return index;
}

/// Opens the node that is largest for its light, until the cut is full.
void LightTree::choose_cut() {
    cut_ = {0};
    while (cut_.size() < kCutSize) {
        auto worth = [&](std::int32_t n) {
            return nodes_[n].left < 0 ? -1.f : nodes_[n].intensity * nodes_[n].radius2;
        };
        const auto it = std::max_element(cut_.begin(), cut_.end(), [&](auto a, auto b) {
            return worth(a) < worth(b);
        });
        if (worth(*it) < 0) break;
        const Node& opened = nodes_[*it];
        *it = opened.left;
        cut_.push_back(opened.right);
    }
    for (std::int32_t n : cut_) nodes_[n].in_cut = true;
}

/// Upper bound of the cosine at the emitter over the box, times intensity, over squared
/// distance; inside the sphere around the box the distance is not known better than its
/// radius.
float LightTree::Node::importance(Vec3f position) const {
    const Vec3f to = position - center;
    const float d2 = length_squared(to);
    const float strength = intensity / std::max(std::max(d2, radius2), 1e-20f);
    if (cos_spread <= -1 || d2 <= radius2) return strength;
    const float inverse_d = 1 / std::sqrt(d2);
    float cos_axis = dot(axis, to) * inverse_d;
    if (two_sided) cos_axis = std::abs(cos_axis);
    const float sin_axis = sine(cos_axis);
    // theta' = max(0, theta - spread - angle under which the sphere is seen)
    const float cos_1 = cos_difference(cos_axis, sin_axis, cos_spread, sin_spread);
    const float sin_1 = sin_difference(cos_axis, sin_axis, cos_spread, sin_spread);
    const float sin_box = std::sqrt(radius2) * inverse_d;
    const float cos_final = cos_difference(cos_1, sin_1, sine(sin_box), sin_box);
    if (cos_final < cos_falloff - kCosineSlack) return 0;
    return strength * std::max(cos_final, kCosineSlack);
}

float LightTree::importance(Vec3f position) const {
    float sum = 0;
    for (std::int32_t n : cut_) sum += nodes_[n].importance(position);
    return sum;
}

std::optional<LightTree::Choice> LightTree::sample(Vec3f position, float u) const {
    std::array<float, kCutSize> weights;
    float sum = 0;
    for (std::size_t i = 0; i < cut_.size(); ++i) {
        sum += weights[i] = nodes_[cut_[i]].importance(position);
    }
    if (!(sum > 0)) return std::nullopt;

    float rest = u * sum;
    std::size_t chosen = cut_.size();
    for (std::size_t i = 0; i < cut_.size(); ++i) {
        if (weights[i] <= 0) continue;
        chosen = i;  // the last possible one, if rounding runs past the end
        if (rest < weights[i]) break;
        rest -= weights[i];
    }
    float probability = weights[chosen] / sum;
    u = std::min(rest / weights[chosen], 0x1.fffffep-1f);

    const Node* node = &nodes_[cut_[chosen]];
    while (node->left >= 0) {
        const float left = nodes_[node->left].importance(position);
        const float right = nodes_[node->right].importance(position);
        if (!(left + right > 0)) return std::nullopt;
        const float p = left / (left + right);
        const bool go_left = u < p;
        u = std::min(go_left ? u / p : (u - p) / (1 - p), 0x1.fffffep-1f);
        probability *= go_left ? p : 1 - p;
        node = &nodes_[go_left ? node->left : node->right];
    }
    return Choice{node->light, probability};
}

float LightTree::probability(Vec3f position, int light) const {
    const float sum = importance(position);
    if (!(sum > 0)) return 0;
    float probability = 1;
    std::int32_t n = leaf_of_[light];
    for (; !nodes_[n].in_cut; n = nodes_[n].parent) {
        const Node& parent = nodes_[nodes_[n].parent];
        const float left = nodes_[parent.left].importance(position);
        const float right = nodes_[parent.right].importance(position);
        if (!(left + right > 0)) return 0;
        const float p = left / (left + right);
        probability *= n == parent.left ? p : 1 - p;
    }
    return probability * nodes_[n].importance(position) / sum;
}

}  // namespace dg
