// tracking.h -- light through a medium whose density changes from place to place, by collisions that are drawn from
// bounds of the density (Woodcock et al. 1965; null collisions: Novak et al. 2018, Monte Carlo Methods for Volumetric
// Light Transport Simulation, STAR).
#pragma once
#include "medium/medium.h"
#include "medium/ray_random.h"

namespace dg {

/// A ray through a grid, in the space of its unit cube. Distances are those of the ray, m.
struct GridRay {
    const DensityGrid& grid;
    Vec3d origin, direction;

    float density(double t) const { return grid.at(origin + direction * t); }
};

/// The share of light left after the way from `begin` to `end`, on average: residual ratio tracking, with the least
/// density of each block as its control. Source: Novak, Selle and Jarosz 2014, Residual Ratio Tracking for Estimating
/// Attenuation in Participating Media, ACM TOG 33(6).
Spectrum ratio_tracking(const GridRay& ray, Spectrum extinction, double begin, double end, RayRandom random);

/// A path through the grid up to a collision or to the end: delta tracking, by one of its wavelengths, which is chosen
/// by `lanes` (segment.h).
struct Tracked {
    bool scattered = false;
    double t = 0;               // of the collision
    Spectrum weight, lanes;     // factor on what the path carries, and its lanes from there on
    Spectrum emitted{0.f};      // radiance that the medium adds on the way, by what reaches the start
};
Tracked delta_tracking(const GridRay& ray, const MediumAt& medium, Spectrum lanes, bool hero_only, double begin,
                       double end, RayRandom random);

}  // namespace dg
