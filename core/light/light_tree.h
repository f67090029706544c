// light_tree.h -- a tree of lights with a position. Chooses a light for a shading point with a probability close to
// proportional to its unoccluded illuminance, in O(log n). Source: Conty Estevez and Kulla 2018, Importance Sampling of
// Many Lights with Adaptive Tree Splitting. The four children of a node are stored in three cache lines and weighed
// together; a binary tree would load six times as many lines in sequence.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light_bounds.h"

namespace dg {

/// Data for the estimate of a light or a group.
struct LightEmission {
    Vec3f center;       // of the sphere around the box, m
    float radius;       // m
    Vec3f axis;
    float intensity;    // cd; 0: empty
    float cos_spread, cos_falloff;
    float reach;        // m: points farther behind the center along the axis are dark. -1: emits along -axis, too
};

/// Four lights or groups.
struct alignas(64) LightNode {
    static constexpr int kWide = 4;
    static constexpr std::size_t kFacts = sizeof(LightEmission) / sizeof(float);
    float facts[kFacts][kWide] = {};
    std::int32_t next[kWide] = {};   // node of a group, or ~light

    LightNode() {   // a missing child has intensity 0; its cos_spread of -1 keeps weigh_node() on its fast path
        for (float& cos_spread : facts[8]) cos_spread = -1;
    }
};

class LightTree {
  public:
    LightTree() = default;
    /// Intensities must be positive.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const { return nodes_.empty(); }
    std::size_t size() const { return place_.size(); }
    /// A tree of a single light, which is chosen without evaluating its estimate.
    bool lone() const { return place_.size() == 1; }
    /// Estimated illuminance (lux) by the children of the first two nodes; their sum estimates the total. A single
    /// group would be inaccurate for points surrounded by lights. `where`: a point, or a segment in a medium
    /// (light_segment.h) for single scattering.
    struct Weights {
        std::array<float, 2 * LightNode::kWide> of;
        float sum;
    };
    template <typename Where>
    Weights weigh(const Where& where) const;
    float importance(Vec3f position) const { return weigh(position).sum; }
    static constexpr std::size_t kMostAtOnce = 4;
    struct Choice {
        int light;
        float probability;
    };
    /// Chooses a light; empty if no light reaches the position. Every light that can reach the position, or a point of
    /// the segment, has a positive probability.
    std::optional<Choice> sample(Vec3f position, float u) const { return sample(weigh(position), position, u); }
    /// Chooses a light by the result of weigh(), which is not used for a single light.
    template <typename Where>
    std::optional<Choice> sample(const Weights& weights, const Where& where, float u) const;
    /// Chooses a light for each `u` like sample(), with probability 0 instead of an empty result. Choices are
    /// interleaved, to hide memory latency.
    void sample(const Weights& weights, Vec3f position, std::span<const float> u, std::span<Choice> found) const;
    /// Choice::probability of sample(), bit-identical.
    float probability(Vec3f position, int light) const;

  private:
    /// State of a choice: the next node, or ~light.
    struct Descent {
        std::int32_t next;
        float probability, u;
    };
    Descent start(const Weights& weights, float u) const;
    template <typename Where>
    void descend(Descent& d, const Where& where) const;
    bool has_second() const { return nodes_.size() > 1 && parent_[1] < 0; }

    std::vector<LightNode> nodes_;       // subtrees are contiguous
    std::vector<std::int32_t> parent_;   // per node: parent node * kWide + child index; -1: one of the first two
    std::vector<std::int32_t> place_;    // per light: node * kWide + child index
};

}  // namespace dg
