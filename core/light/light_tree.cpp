// light_tree.cpp -- chooses lights from the light tree.
#include "light/light_tree.h"

#include <algorithm>
#include <cmath>

#include "light/light_tree_build.h"
#include "light/light_segment.h"
#include "math/below_one.h"

namespace dg {
namespace {

constexpr int kWide = LightNode::kWide;

float larger(float a, float b) {  // by value, so that loops are vectorized
    return a > b ? a : b;
}

/// Upper bound of the cosine at the emitter over the box, times intensity over squared distance; inside the sphere
/// around the box, the distance is bounded by its radius. Without branches, for four children at a time.
inline float estimate(const LightEmission& e, Vec3f position) {
    // Cosines and sines are scaled by the distance, so that square roots depend only on d2 and run in parallel.
    const Vec3f to = position - e.center;
    const float d2 = length_squared(to), radius2 = e.radius * e.radius;
    const float inverse_d2 = 1 / larger(larger(d2, radius2), 1e-20f);
    const float d = std::sqrt(d2);
    const float along = dot(e.axis, to);
    const float cos_axis = e.reach < 0 ? larger(along, -along) : along;
    const float sin_axis = std::sqrt(larger(d2 - cos_axis * cos_axis, 0.f));
    const float cos_box = std::sqrt(larger(d2 - radius2, 0.f));
    const float sin_spread = std::sqrt(larger(1 - e.cos_spread * e.cos_spread, 0.f));
    // theta' = max(0, theta - spread - angular radius of the sphere)
    const bool within = cos_axis > e.cos_spread * d;
    const float cos_1 = within ? d : cos_axis * e.cos_spread + sin_axis * sin_spread;
    const float sin_1 = within ? 0.f : sin_axis * e.cos_spread - cos_axis * sin_spread;
    const float turned = (cos_1 * cos_box + sin_1 * e.radius) * inverse_d2;
    const float cos_final = cos_1 > cos_box ? 1.f : turned;
    const float strength = e.intensity * inverse_d2;
    const float dimmed = strength * larger(cos_final, kCosineSlack);
    const float facing = cos_final < e.cos_falloff - kCosineSlack ? 0.f : dimmed;
    const bool anywhere = (e.cos_spread <= -1) | (d2 <= radius2);
    const float some = anywhere ? strength : facing;
    const bool behind = (e.reach >= 0) & (along + e.reach < 0);
    return behind ? 0.f : some;
}

/// Computes the weights of a node's children; returns their sum.
inline float weigh_node(const LightNode& node, Vec3f position, float* weights) {
    const auto& n = node.facts;
    const bool around = larger(larger(n[8][0], n[8][1]), larger(n[8][2], n[8][3])) <= -1;
    if (around) {   // point lights without cosines; bit-identical to estimate()
        for (int i = 0; i < kWide; ++i) {
            const float d2 = length_squared(position - Vec3f{n[0][i], n[1][i], n[2][i]});
            weights[i] = n[7][i] * (1 / larger(larger(d2, n[3][i] * n[3][i]), 1e-20f));
        }
        return (weights[0] + weights[1]) + (weights[2] + weights[3]);
    }
    for (int i = 0; i < kWide; ++i)
        weights[i] = estimate({{n[0][i], n[1][i], n[2][i]}, n[3][i], {n[4][i], n[5][i], n[6][i]}, n[7][i], n[8][i],
                               n[9][i], n[10][i]},
                              position);
    return (weights[0] + weights[1]) + (weights[2] + weights[3]);
}

/// Chooses a child by weight, and rescales u for the next choice. Counts instead of searching, to avoid unpredictable
/// branches.
template <std::size_t n>
std::size_t choose(const float* weights, float sum, float& u) {
    const float target = u * sum;
    float before = 0, below = 0;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        below += weights[i];
        const bool beyond = target >= below;
        chosen += beyond;
        before = beyond ? below : before;
    }
    // Rounding may run past the last child with a positive weight; weights overflow very close to very bright lights.
    while (chosen > 0 && !(weights[chosen] > 0)) --chosen;
    u = std::clamp((target - before) / weights[chosen], 0.f, kBelowOne);
    return chosen;
}

}  // namespace

LightTree::LightTree(std::span<const LightBounds> lights) {
    if (lights.empty()) return;
    LightBranch tree = build_light_tree(lights);
    nodes_ = std::move(tree.nodes);
    parent_ = std::move(tree.parent);
    place_.resize(lights.size());
    for (std::size_t node = 0; node < nodes_.size(); ++node)
        for (int i = 0; i < kWide; ++i)
            if (const std::int32_t next = nodes_[node].next[i]; next < 0)
                place_[~next] = std::int32_t(node) * kWide + i;
}

template <typename Where>
LightTree::Weights LightTree::weigh(const Where& where) const {
    Weights w;
    w.sum = weigh_node(nodes_[0], where, w.of.data());
    if (has_second()) w.sum += weigh_node(nodes_[1], where, w.of.data() + kWide);
    return w;
}

template LightTree::Weights LightTree::weigh(const Vec3f&) const;
template LightTree::Weights LightTree::weigh(const LightSegment&) const;

/// At least one of `weights` is positive.
LightTree::Descent LightTree::start(const Weights& top, float u) const {
    const std::size_t first = has_second() ? choose<2 * kWide>(top.of.data(), top.sum, u)
                                           : choose<kWide>(top.of.data(), top.sum, u);
    return {nodes_[first / kWide].next[first % kWide], top.of[first] / top.sum, u};
}

/// Descends one level; ends with probability 0 if no child has a positive weight.
template <typename Where>
void LightTree::descend(Descent& d, const Where& where) const {
    const LightNode& node = nodes_[d.next];
    float weights[kWide];
    const float sum = weigh_node(node, where, weights);
    if (!(sum > 0)) {
        d.next = -1, d.probability = 0;
        return;
    }
    const std::size_t chosen = choose<kWide>(weights, sum, d.u);
    d.probability *= weights[chosen] / sum;
    d.next = node.next[chosen];
}

template <typename Where>
std::optional<LightTree::Choice> LightTree::sample(const Weights& top, const Where& where, float u) const {
    if (lone()) return Choice{0, 1};
    if (!(top.sum > 0)) return std::nullopt;
    Descent d = start(top, u);
    while (d.next >= 0) descend(d, where);
    if (!(d.probability > 0)) return std::nullopt;
    return Choice{~d.next, d.probability};
}

template std::optional<LightTree::Choice> LightTree::sample(const Weights&, const Vec3f&, float) const;
template std::optional<LightTree::Choice> LightTree::sample(const Weights&, const LightSegment&, float) const;

void LightTree::sample(const Weights& top, Vec3f position, std::span<const float> u,
                       std::span<Choice> found) const {
    if (lone() || !(top.sum > 0)) {
        std::ranges::fill(found, Choice{0, lone() ? 1.f : 0.f});
        return;
    }
    std::array<Descent, kMostAtOnce> all;
    for (std::size_t i = 0; i < found.size(); ++i) all[i] = start(top, u[i]);
    for (bool on = true; on;) {
        on = false;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (all[i].next >= 0) descend(all[i], position), on = true;
    }
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = {~all[i].next, all[i].probability};
}

float LightTree::probability(Vec3f position, int light) const {
    if (lone()) return 1;
    std::array<std::int32_t, kLightTreeDepth> way;   // child positions, from the light up
    int depth = 0;
    for (std::int32_t place = place_[light]; place >= 0; place = parent_[place / kWide]) way[depth++] = place;
    const Weights top = weigh(position);
    if (!(top.sum > 0)) return 0;
    float probability = top.of[way[--depth]] / top.sum;
    while (depth > 0 && probability > 0) {
        const std::int32_t place = way[--depth];
        float weights[kWide];
        const float sum = weigh_node(nodes_[place / kWide], position, weights);
        if (!(sum > 0)) return 0;
        probability *= weights[place % kWide] / sum;
    }
    return probability;
}

}  // namespace dg
