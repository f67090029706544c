// node_fill.h -- values for nodes of a grid at which rays are lost, from those beside them.
#pragma once
#include <utility>
#include <vector>

#include "render/flare/maps/map_rays.h"

namespace dg {

/// Gives landings to the nodes without one that lie beside others, along straight lines; how far beyond an edge they are
/// stays. `side`: nodes across.
void fill_landings(std::vector<MapLanding>& nodes, int side);

/// Calls fill(node, nodes beside it) for the nodes that are not sound but lie beside sound ones, until all of them are.
template <typename Fill>
void fill_from_beside(std::vector<bool> sound, int side, const Fill& fill) {
    for (bool more = true; more;) {
        more = false;
        const std::vector<bool> before = sound;
        for (int n = 0; n < side * side; ++n) {
            if (before[n]) continue;
            std::vector<int> beside;
            for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                const int x = n % side + dx, y = n / side + dy;
                if (x >= 0 && y >= 0 && x < side && y < side && before[y * side + x]) beside.push_back(y * side + x);
            }
            if (!beside.empty()) fill(n, beside), sound[n] = more = true;
        }
    }
}

}  // namespace dg
