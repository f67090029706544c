// light_tree_build.h -- the tree of lights from their bounds.
#pragma once
#include "light/light_tree.h"

namespace dg {

/// Rounding must not turn a light off at the very edge of its cone.
inline constexpr float kCosineSlack = 1e-3f;
/// Nodes from the top to a light, at most.
inline constexpr int kLightTreeDepth = 64;

/// Nodes with what they hang from, as LightTree keeps them; the first two are the top, or the first alone.
struct LightBranch {
    std::vector<LightNode> nodes;
    std::vector<std::int32_t> parent;
};
LightBranch build_light_tree(std::span<const LightBounds> lights);

}  // namespace dg
