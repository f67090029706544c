// drawn_ghosts.h -- the ghosts of a source, and those of them that matter.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/live/live_ghost.h"

namespace dg {

/// A ghost with the rays that it is made of.
struct DrawnGhost {
    int pair;   // of reflections, see FlareAim
    std::unique_ptr<MapRays> rays;
    std::unique_ptr<LiveGhost> ghost;
    double worth = 0;
};

/// All ghosts of two reflections whose light comes to the frame. `known`: of each pair; nothing: it brings none. Null:
/// nothing is known. It and the source outlive them.
std::vector<DrawnGhost> ghosts_of(const FlareAim& aim, const LiveSource& source, const Sensor& sensor,
                                  const std::vector<std::optional<KnownGhost>>* known, int threads);

/// Keeps the brightest, without those that nobody would miss: `dim` is what they are worth among all, at most. Returns
/// what the others are worth.
double choose(std::vector<DrawnGhost>& all, const Sensor& sensor, double dim);

}  // namespace dg
