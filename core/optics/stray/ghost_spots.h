// ghost_spots.h -- position, size and brightness on the film of each ghost of a lens, for light
// from one direction.
#pragma once
#include <array>
#include <vector>

#include "optics/stray/ghost_lens.h"

namespace dg {

/// Collimated light, and size of the film.
struct GhostLight {
    double angle = 0;                // rad from the axis; the source is below the axis, its image above
    Vec2d film_half{18, 12};         // mm
    int rays = 4096;                 // number over the front of the lens
    std::vector<double> nm, weight;  // relative weights, of sum 1
};

struct GhostSpot {
    Mirrors mirrors;
    double light = 0;   // on the film, relative to the image of the same source on the axis
    double all = 0;     // the same, over the whole plane of the film
    Vec2d center{};     // mm, centroid of the light on the film
    double radius = 0;  // mm, RMS distance from the centroid
    std::vector<std::array<float, 3>> points{};   // x, y (mm) and share of `light`
};

/// Spots of all ghosts, brightest on the film first; with the points of all rays on request.
std::vector<GhostSpot> ghost_spots(const GhostLens& lens, const GhostLight& light, bool with_points);

}  // namespace dg
