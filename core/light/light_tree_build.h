// light_tree_build.h -- builds the light tree from bounds of lights.
#pragma once
#include "light/light_tree.h"

namespace dg {

/// Tolerance of cone angles, so that rounding does not exclude lights at the edge of their cones.
inline constexpr float kCosineSlack = 1e-3f;
/// Largest depth of a light.
inline constexpr int kLightTreeDepth = 64;

/// Nodes with parents, as in LightTree; the first two nodes, or the first alone, are roots.
struct LightBranch {
    std::vector<LightNode> nodes;
    std::vector<std::int32_t> parent;
};
LightBranch build_light_tree(std::span<const LightBounds> lights);

}  // namespace dg
