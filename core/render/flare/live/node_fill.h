// node_fill.h -- extrapolates values to grid nodes with lost rays from their neighbours.
#pragma once
#include <utility>
#include <vector>

#include "render/flare/maps/map_rays.h"

namespace dg {

/// Extrapolates landings linearly to nodes without a landing next to nodes with a landing; clip values are not changed.
/// `side`: nodes per row.
void fill_landings(std::vector<MapLanding>& nodes, int side);

/// Calls fill(node, neighbours) for nodes that are not sound but have sound neighbours, until all nodes are sound.
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
