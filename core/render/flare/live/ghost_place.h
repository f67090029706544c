// ghost_place.h -- through which part of the front a ghost comes to the frame, and how its glass is there: what changes
// little while the source turns, and is kept.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "render/flare/flare_cells.h"
#include "render/flare/live/live_source.h"

namespace dg {

/// For sources in one direction.
struct GhostPlace {
    using Spectrum = std::array<float, LiveSource::kNodes>;   // transmittance at nodes of the wavelength

    FlareRectangle region;           // of the square that holds the front
    double share = 0;                // worth among all ghosts
    int side = 0;                    // nodes of the region across
    std::vector<Spectrum> spectra;   // at its nodes, row by row

    /// At a place of the region, [0, 1]^2: bilinear.
    Spectrum spectrum(Vec2f u) const;
};

/// A ghost of a source between two such directions: nothing of it that is exact.
struct KnownGhost {
    std::array<std::shared_ptr<const GhostPlace>, 2> places;   // null: no light comes from there
    float weight;                                              // of the second
    FlareRectangle region;                                     // about
    double share;                                              // the larger one

    /// Between two directions, one of which at least has a place.
    KnownGhost(std::shared_ptr<const GhostPlace> a, std::shared_ptr<const GhostPlace> b, float weight_of_b);
    /// The regions of the two directions do not meet: the ghost has several parts, and each direction found another one.
    bool jumps() const;
    /// At a place of the front's square.
    GhostPlace::Spectrum spectrum(Vec2f at) const;
};

}  // namespace dg
