// light_tree.h -- a tree of lights with a place, from which one is chosen for a shaded point with a probability
// close to the illuminance that it may bring there; O(log n). Source: Conty Estevez and Kulla 2018, Importance
// Sampling of Many Lights with Adaptive Tree Splitting. Four children lie side by side in three lines of the cache
// and are weighed at once: a binary tree loads six times as many lines, and waits for them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light_bounds.h"

namespace dg {

/// Facts that the estimate of a light or a group needs.
struct LightEmission {
    Vec3f center;       // of the sphere around the box, m
    float radius;       // m
    Vec3f axis;
    float intensity;    // cd; 0: none there
    float cos_spread, cos_falloff;
    float reach;        // m; what lies farther behind the centre along the axis is dark. -1: shines along -axis as well
};

/// Four lights or groups.
struct alignas(64) LightNode {
    static constexpr int kWide = 4;
    static constexpr std::size_t kFacts = sizeof(LightEmission) / sizeof(float);
    float facts[kFacts][kWide] = {};
    std::int32_t next[kWide] = {};   // node of a group, or ~light

    LightNode() {   // children that are not there shine with intensity 0, all around as others may
        for (float& cos_spread : facts[8]) cos_spread = -1;
    }
};

class LightTree {
  public:
    LightTree() = default;
    /// Every intensity must be > 0.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const { return nodes_.empty(); }
    std::size_t size() const { return place_.size(); }
    /// One light alone: it is chosen without a look, wherever it shines.
    bool lone() const { return place_.size() == 1; }
    /// Illuminance that the lights and groups of the first two nodes bring to a point: one group alone knows too
    /// little where lights surround the point. The sum is an estimate of the illuminance (lux) by all together. `where`
    /// is a point, or a way through a medium (LightWay, light_way.h) for what it scatters once.
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
    /// Empty where no light shines. A light that can reach the position, or any place of the way, has probability > 0.
    std::optional<Choice> sample(Vec3f position, float u) const { return sample(weigh(position), position, u); }
    /// The same with weigh() at hand, which a lone light has no use for.
    template <typename Where>
    std::optional<Choice> sample(const Weights& weights, const Where& where, float u) const;
    /// Each `u` by itself as sample() would have it, probability 0 where that is empty; side by side, as the processor
    /// waits for each.
    void sample(const Weights& weights, Vec3f position, std::span<const float> u, std::span<Choice> found) const;
    /// Choice::probability of sample(), to the bit.
    float probability(Vec3f position, int light) const;

  private:
    /// A light that is being chosen: the node that is next, or ~light.
    struct Descent {
        std::int32_t next;
        float probability, u;
    };
    Descent start(const Weights& weights, float u) const;
    template <typename Where>
    void descend(Descent& d, const Where& where) const;
    bool has_second() const { return nodes_.size() > 1 && parent_[1] < 0; }

    std::vector<LightNode> nodes_;       // those of a subtree follow each other
    std::vector<std::int32_t> parent_;   // by node: its place, node * kWide + which; -1: one of the first two
    std::vector<std::int32_t> place_;    // by light
};

}  // namespace dg
