// flare_learn.h -- which emitters light which ghosts, through which part of the front lens and at which
// wavelengths, found by exact rays.
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

/// `mapped`: sources whose ghosts by two reflections are drawn from maps; none of a shorter list. Empty where nothing
/// shines, or nothing reflects, or maps have all.
FlareKnowledge learn_flare(const FlareAim& aim, int threads, const std::vector<bool>& mapped = {});
/// The same without a look: all pairs, all of the square and all wavelengths alike.
FlareKnowledge naive_flare(const FlareAim& aim);

}  // namespace dg
