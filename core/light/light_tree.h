// light_tree.h -- a binary tree of lights with a place, from which one is chosen for a
// shaded point with a probability close to the illuminance that it may bring there; O(log
// n). Source: Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with
// Adaptive Tree Splitting.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Where a light (or a group) is and where it may shine: a box, and directions within
/// `spread` of the axis, from which emission goes on for `falloff` (weakened by the
/// cosine) and is 0 beyond.
struct LightBounds {
    Vec3f min, max;           // m
    Vec3f axis{0, 0, 1};      // unit
    float spread = kPi;       // rad; pi: all around
    float falloff = kPi / 2;  // rad
    float intensity = 0;      // cd, largest over the directions
    bool two_sided = false;   // shines along -axis as well
};

class LightTree {
  public:
    LightTree() = default;
    /// Every intensity must be > 0.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const { return nodes_.empty(); }
    /// Estimate of the illuminance (lux) that all lights together bring to a point.
    float importance(Vec3f position) const;
    struct Choice {
        int light;
        float probability;
    };
    /// Empty where no light shines. A light that can reach the position has probability >
    /// 0.
    std::optional<Choice> sample(Vec3f position, float u) const;
    float probability(Vec3f position, int light) const;

  private:
    struct Node {
        Vec3f center;
        float radius2;  // of the sphere around the box, m^2
        Vec3f axis;
        float cos_spread, sin_spread, cos_falloff;
        float intensity;
        bool two_sided;
        std::int32_t parent = -1, left = -1, right = -1;  // left < 0: a leaf
        std::int32_t light = -1;
        bool in_cut = false;
        float importance(Vec3f position) const;
    };
    static Node make_node(const LightBounds& b);
    std::int32_t build(std::span<const LightBounds> lights, std::span<std::int32_t> order,
                       LightBounds& bounds);
    void choose_cut();

    std::vector<Node> nodes_;            // parents before children
    std::vector<std::int32_t> leaf_of_;  // by light
    std::vector<std::int32_t> cut_;      // nodes that are weighed one by one
};

}  // namespace dg
