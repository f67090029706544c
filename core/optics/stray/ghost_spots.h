// ghost_spots.h -- what each ghost of a lens does with the light of one direction: how bright it is on the film,
// where, and how large.
#pragma once
#include <array>
#include <vector>

#include "optics/stray/ghost_lens.h"

namespace dg {

/// Light from infinity, and what of the film counts.
struct GhostLight {
    double angle = 0;                // rad from the axis; light comes from below it, and lands above
    Vec2d film_half{18, 12};         // mm
    int rays = 4096;                 // over the front of the lens
    std::vector<double> nm, weight;  // shares of the light, of sum 1
};

struct GhostSpot {
    Mirrors mirrors;
    double light = 0;   // on the film, over that of the picture of the same source straight ahead
    double all = 0;     // the same wherever it lands on the film's plane
    Vec2d center{};     // mm, of what lands on the film
    double radius = 0;  // mm, RMS about the centre
    std::vector<std::array<float, 3>> points{};   // x, y (mm) and share of `light`
};

/// By light on the film, brightest first; with the points where rays landed if asked for.
std::vector<GhostSpot> ghost_spots(const GhostLens& lens, const GhostLight& light, bool with_points);

}  // namespace dg
