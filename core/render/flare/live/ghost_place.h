// ghost_place.h -- the part of the front through which a ghost reaches the frame, and the transmittance there. Both
// vary slowly with the source's direction, and are cached.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "render/flare/flare_cells.h"
#include "render/flare/live/live_source.h"

namespace dg {

/// Region and spectra of a ghost for a source direction.
struct GhostPlace {
    using Spectrum = std::array<float, LiveSource::kNodes>;   // transmittance at nodes of the wavelength

    FlareRectangle region;           // rectangle of the front's square
    double share = 0;                // share of the worth of all ghosts
    int side = 0;                    // nodes along each axis of the region
    std::vector<Spectrum> spectra;   // at its nodes, row by row

    /// Bilinear interpolation at a point of the region, [0, 1]^2.
    Spectrum spectrum(Vec2f u) const;
};

/// A ghost of a source between two cached directions. All values are approximate.
struct KnownGhost {
    std::array<std::shared_ptr<const GhostPlace>, 2> places;   // null: no light from that direction
    float weight;                                              // interpolation weight of the second
    FlareRectangle region;                                     // approximate
    double share;                                              // the larger of both shares

    /// At least one of the directions must have a place.
    KnownGhost(std::shared_ptr<const GhostPlace> a, std::shared_ptr<const GhostPlace> b, float weight_of_b);
    /// Whether the regions of the two directions are disjoint: the ghost has several parts, and the directions found
    /// different ones.
    bool jumps() const;
    /// Approximate spectrum at a point of the front's square.
    GhostPlace::Spectrum spectrum(Vec2f at) const;
};

}  // namespace dg
