// light_tree.cpp -- building the tree of lights, and choosing from it.
#include "light/light_tree.h"

#include <cstring>
#include <numeric>

#include "light/light_split.h"

namespace dg {
namespace {

// Rounding must not turn a light off at the very edge of its cone.
constexpr float kCosineSlack = 1e-3f;
// Normals this close (rad) are one.
constexpr float kFlatSpread = 1e-3f;

float larger(float a, float b) {  // by value, so that loops over it become SIMD
    return a > b ? a : b;
}

float sine(float cosine) {
    return std::sqrt(std::max(0.f, 1 - cosine * cosine));
}

// Beyond this depth lights are halved by number, so that no arrangement of them makes the
// tree so deep that its recursion is in danger.
constexpr int kDeepest = 48;

}  // namespace

LightTree::LightTree(std::span<const LightBounds> lights) : leaf_of_(lights.size()) {
    if (lights.empty()) return;
    std::vector<std::int32_t> order(lights.size());
    std::iota(order.begin(), order.end(), 0);
    nodes_.reserve(2 * lights.size());
    LightBounds all;
    build(lights, order, 0, all);
    choose_cut();
    pack_cut();
}

LightTree::Node LightTree::make_node(const LightBounds& b) {
    Node n;
    n.center = (b.min + b.max) * 0.5f;
    n.radius2 = length_squared(b.max - b.min) * 0.25f;
    n.radius = std::sqrt(n.radius2);
    n.axis = b.axis;
    n.cos_spread = std::cos(b.spread);
    n.sin_spread = sine(n.cos_spread);
    n.cos_falloff = std::cos(b.falloff);
    n.intensity = b.intensity;
    n.back = b.two_sided ? -1.f : 1.f;
    // Where all normals are one, the planes of the lights bound what they shine at: signs
    // on a wall, panels of a ceiling.
    const bool flat = b.spread <= kFlatSpread && b.falloff <= kPi / 2 && !b.two_sided;
    const Vec3f half = (b.max - b.min) * (0.5f + kCosineSlack);
    const Vec3f a{std::abs(b.axis.x), std::abs(b.axis.y), std::abs(b.axis.z)};
    n.reach = flat ? dot(a, half) + kFlatSpread * n.radius
                   : std::numeric_limits<float>::infinity();
    return n;
}

std::int32_t LightTree::build(std::span<const LightBounds> lights,
                              std::span<std::int32_t> order, int depth,
                              LightBounds& bounds) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    if (order.size() == 1) {
        bounds = lights[order[0]];
        nodes_[index] = make_node(bounds);
        nodes_[index].light = order[0];
        leaf_of_[order[0]] = index;
        return index;
    }
    const std::size_t first = split_lights(lights, order, depth > kDeepest);
    LightBounds left_bounds, right_bounds;
    const std::int32_t left = build(lights, order.first(first), depth + 1, left_bounds);
    const std::int32_t right =
        build(lights, order.subspan(first), depth + 1, right_bounds);
    bounds = merge(left_bounds, right_bounds);
    nodes_[index] = make_node(bounds);
    nodes_[index].left = left;
    nodes_[index].right = right;
    nodes_[left].parent = nodes_[right].parent = index;
    return index;
}

/// The root alone knows too little when lights surround the point, so the first choice is
/// made among the nodes of a cut through the tree. Opens the node that is largest for its
/// light, until the cut is full.
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

void LightTree::pack_cut() {
    for (std::size_t i = 0; i < cut_.size(); ++i) {
        const Emission& e = nodes_[cut_[i]];
        float values[sizeof(Emission) / sizeof(float)];
        std::memcpy(values, &e, sizeof values);
        for (std::size_t k = 0; k < std::size(values); ++k) {
            packed_[i / 4].of[k][i % 4] = values[k];
        }
    }
}

/// Upper bound of the cosine at the emitter over the box, times intensity, over squared
/// distance; inside the sphere around the box the distance is not known better than its
/// radius. Without branches, for four nodes at once.
inline float LightTree::estimate(const Emission& e, Vec3f position) {
    // Cosines and sines are all times the distance, so that the three roots wait for
    // nothing but d2, and not for each other.
    const Vec3f to = position - e.center;
    const float d2 = length_squared(to);
    const float inverse_d2 = 1 / larger(larger(d2, e.radius2), 1e-20f);
    const float d = std::sqrt(d2);
    const float along = dot(e.axis, to);
    const float cos_axis = larger(along, along * e.back);
    const float sin_axis = std::sqrt(larger(d2 - cos_axis * cos_axis, 0.f));
    const float cos_box = std::sqrt(larger(d2 - e.radius2, 0.f));
    // theta' = max(0, theta - spread - angle under which the sphere is seen)
    const bool within = cos_axis > e.cos_spread * d;
    const float cos_1 = within ? d : cos_axis * e.cos_spread + sin_axis * e.sin_spread;
    const float sin_1 = within ? 0.f : sin_axis * e.cos_spread - cos_axis * e.sin_spread;
    const float turned = (cos_1 * cos_box + sin_1 * e.radius) * inverse_d2;
    const float cos_final = cos_1 > cos_box ? 1.f : turned;
    const float strength = e.intensity * inverse_d2;
    const float dimmed = strength * larger(cos_final, kCosineSlack);
    const float facing = cos_final < e.cos_falloff - kCosineSlack ? 0.f : dimmed;
    const bool anywhere = (e.cos_spread <= -1) | (d2 <= e.radius2);
    const float some = anywhere ? strength : facing;
    return along + e.reach < 0 ? 0.f : some;
}

float LightTree::Node::importance(Vec3f position) const {
    return estimate(*this, position);
}

LightTree::Weights LightTree::weigh(Vec3f position) const {
    Weights weights;
    for (std::size_t first = 0; first < cut_.size(); first += 4) {
        const auto& n = packed_[first / 4].of;
        for (int i = 0; i < 4; ++i) {
            weights.of_cut[first + i] = estimate({{n[0][i], n[1][i], n[2][i]},
                                                  n[3][i],
                                                  n[4][i],
                                                  {n[5][i], n[6][i], n[7][i]},
                                                  n[8][i],
                                                  n[9][i],
                                                  n[10][i],
                                                  n[11][i],
                                                  n[12][i],
                                                  n[13][i]},
                                                 position);
        }
    }
    weights.sum = 0;
    for (std::size_t i = 0; i < cut_.size(); ++i) weights.sum += weights.of_cut[i];
    return weights;
}

std::optional<LightTree::Choice> LightTree::sample(const Weights& cut, Vec3f position,
                                                   float u) const {
    const auto& weights = cut.of_cut;
    const float sum = cut.sum;
    if (!(sum > 0)) return std::nullopt;

    // Counted, not searched: which one it is cannot be foreseen by the processor.
    const float target = u * sum;
    float before = 0, below = 0;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i + 1 < cut_.size(); ++i) {
        below += weights[i];
        const bool beyond = target >= below;
        chosen += beyond;
        before = beyond ? below : before;
    }
    // Rounding may run past the last one that shines.
    while (!(weights[chosen] > 0)) --chosen;
    float probability = weights[chosen] / sum;
    const Node* node = &nodes_[cut_[chosen]];
    if (node->left < 0) return Choice{node->light, probability};
    u = std::clamp((target - before) / weights[chosen], 0.f, 0x1.fffffep-1f);
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
