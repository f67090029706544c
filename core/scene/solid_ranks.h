// solid_ranks.h -- which of two overlapping solids fills the space, found when a scene is built.
#pragma once
#include <cstdint>
#include <vector>

#include "geometry/bounds.h"

namespace dg {

struct SceneDescription;

/// A solid around a point, and the share of test directions that found the point inside.
struct EnclosingSolid {
    std::uint32_t instance;
    float share;
};

/// A refracting solid, and its bounds over all times.
struct BoundedSolid {
    std::uint32_t instance;
    Bounds bounds;
};

/// Two solids that overlap; the higher fills the space, for the reason `by`.
struct Overlap {
    std::uint32_t lower, higher;
    const char* by;
};

/// Ranks of solids by priority, then by containment, then in the order of the file.
struct SolidRanks {
    std::vector<std::uint32_t> of_instance;   // 0: overlaps no other solid; empty: no solids overlap
    std::vector<char> touches;                // per instance: its boundary may be at the place of another
    std::vector<Overlap> overlaps;            // the first ones by priority or containment, and the first others
    int deepest = 0;                          // the most solids with boxes that hold each other
};

SolidRanks rank_solids(const SceneDescription& scene, const std::vector<BoundedSolid>& solids);

}  // namespace dg
