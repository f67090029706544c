// tracking.h -- delta tracking and ratio tracking in a heterogeneous medium, with density bounds of grid blocks as
// majorants (Woodcock et al. 1965; null collisions: Novak et al. 2018, Monte Carlo Methods for Volumetric Light
// Transport Simulation, STAR).
#pragma once
#include "medium/medium.h"
#include "medium/ray_random.h"

namespace dg {

/// A ray in the space of a grid's unit cube, parameterized by the distance along the world ray, m.
struct GridRay {
    const DensityGrid& grid;
    Vec3d origin, direction;

    float density(double t) const { return grid.at(origin + direction * t); }
};

/// Unbiased estimate of the transmittance from `begin` to `end` by residual ratio tracking, with the minimum density of
/// each block as the control. Source: Novak, Selle and Jarosz 2014, Residual Ratio Tracking for Estimating Attenuation
/// in Participating Media, ACM TOG 33(6).
Spectrum ratio_tracking(const GridRay& ray, Spectrum extinction, double begin, double end, RayRandom random);

/// Result of delta tracking up to a collision or to the end. The wavelength that draws distances is chosen by `lanes`
/// (segment.h).
struct Tracked {
    bool collided = false;
    double t = 0;               // distance of the collision, m
    Spectrum weight, lanes;     // throughput factor, and the lanes after it
    Spectrum emitted{0.f};      // emission along the segment, attenuated to its start
};
Tracked delta_tracking(const GridRay& ray, const MediumAt& medium, Spectrum lanes, bool hero_only, double begin,
                       double end, RayRandom random);

}  // namespace dg
