// light_tree.h -- a binary tree of lights with a place, from which one is chosen for a
// shaded point with a probability close to the illuminance that it may bring there; O(log
// n). Source: Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with
// Adaptive Tree Splitting.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light_bounds.h"

namespace dg {

class LightTree {
  public:
    LightTree() = default;
    /// Every intensity must be > 0.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const { return nodes_.empty(); }
    /// Illuminance that the nodes of the cut bring to a point; the sum is an estimate of the
    /// illuminance (lux) by all lights together.
    static constexpr std::size_t kCutSize = 8;
    struct Weights {
        std::array<float, kCutSize> of_cut;
        float sum;
    };
    Weights weigh(Vec3f position) const;
    float importance(Vec3f position) const { return weigh(position).sum; }
    struct Choice {
        int light;
        float probability;
    };
    /// Empty where no light shines. A light that can reach the position has probability >
    /// 0.
    std::optional<Choice> sample(Vec3f position, float u) const {
        return sample(weigh(position), position, u);
    }
    /// The same with weigh(position) at hand.
    std::optional<Choice> sample(const Weights& weights, Vec3f position, float u) const;
    float probability(Vec3f position, int light) const;

  private:
    /// Facts that the importance needs.
    struct Emission {
        Vec3f center;
        float radius2, radius;  // of the sphere around the box, m
        Vec3f axis;
        float back;  // -1: shines along -axis as well; else 1
        float cos_spread, sin_spread, cos_falloff;
        float intensity;
        float reach;  // m; what lies farther behind the centre along the axis is dark
    };
    struct Node : Emission {
        std::int32_t parent = -1, left = -1, right = -1;  // left < 0: a leaf
        std::int32_t light = -1;
        bool in_cut = false;
        float importance(Vec3f position) const;
    };
    /// Four nodes side by side, weighed at once; those that are missing have no
    /// intensity.
    struct alignas(16) FourNodes {
        float of[sizeof(Emission) / sizeof(float)][4];
    };
    static float estimate(const Emission& e, Vec3f position);
    static Node make_node(const LightBounds& b);
    /// Appends the tree of the lights in `order`; returns the index of its root.
    std::int32_t build(std::span<const LightBounds> lights, std::span<std::int32_t> order,
                       int depth, LightBounds& bounds);
    void choose_cut();
    void pack_cut();

    std::vector<Node> nodes_;                       // parents before children
    std::vector<std::int32_t> leaf_of_;             // by light
    std::vector<std::int32_t> cut_;                 // nodes that are weighed one by one
    std::array<FourNodes, kCutSize / 4> packed_{};  // the same
};

}  // namespace dg
