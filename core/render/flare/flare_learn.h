// flare_learn.h -- learns sampling distributions of pairs of emitter and ghost, front lens points and wavelengths, from
// exact rays.
//
// Source: Pekkarinen and Balzer 2019, Physically Based Lens Flare Rendering in The Lego Movie 2, DigiPro
// (sampling of ghosts and front cells from traced rays).
#pragma once
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/flare_cells.h"

namespace dg {

struct FlareKnowledge {
    DiscreteDistribution pairs;        // source x ghosts + ghost
    std::vector<int> cells_of_pair;
    std::vector<FlareCells> cells;
};

/// `mapped`: sources with maps for ghosts with two reflections; missing entries are false. Empty without light sources
/// or reflections, or if all pairs have maps.
FlareKnowledge learn_flare(const FlareAim& aim, int threads, const std::vector<bool>& mapped = {});
/// Uniform distributions of pairs, the square and wavelengths.
FlareKnowledge naive_flare(const FlareAim& aim);

}  // namespace dg
