// drawn_ghosts.h -- the ghosts of a source, and the selection of relevant ghosts.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/live/live_ghost.h"

namespace dg {

/// A ghost with its rays.
struct DrawnGhost {
    int pair;   // index of the pair of reflections, see FlareAim
    std::unique_ptr<MapRays> rays;
    std::unique_ptr<LiveGhost> ghost;
    double worth = 0;
};

/// All ghosts with two reflections that send light to the frame. `known`: entry per pair, empty for pairs without
/// light; null: unknown. `known` and `source` must outlive the ghosts.
std::vector<DrawnGhost> ghosts_of(const FlareAim& aim, const LiveSource& source, const Sensor& sensor,
                                  const std::vector<std::optional<KnownGhost>>* known, int threads);

/// Keeps the brightest ghosts and removes dim ghosts with a total worth of at most the fraction `dim`. Returns the
/// worth of the remaining ghosts.
double choose(std::vector<DrawnGhost>& all, const Sensor& sensor, double dim);

}  // namespace dg
