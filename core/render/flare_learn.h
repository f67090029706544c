// flare_learn.h -- which emitters light which ghosts, and through which part of the front lens, found by exact
// rays: how much light each pair of source and ghost brings, and from which cells of the front.
//
// Source: Pekkarinen and Balzer 2019, Physically Based Lens Flare Rendering in The Lego Movie 2, DigiPro
// (sampling of ghosts and front cells from traced rays).
#pragma once
#include <vector>

#include "render/flare_aim.h"
#include "render/flare_cells.h"

namespace dg {

struct FlareKnowledge {
    DiscreteDistribution pairs;        // source x ghosts + ghost
    std::vector<int> cells_of_pair;    // -1: evenly
    std::vector<FlareCells> cells;
};

/// Nothing in it where nothing shines, or nothing reflects.
FlareKnowledge learn_flare(const FlareAim& aim, int threads);

}  // namespace dg
