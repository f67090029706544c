// harvey_shack.h -- scatter lobe of polished surfaces about the mirror direction or the refracted
// ray. The lobe is shift-invariant: it depends only on the distance from its centre in direction
// cosines.
//
// Direction cosines here are the tangential components of n x direction: sin(theta) in air.
// Refraction and reflection preserve them, so the lobe is centred on the cosines of the incident
// light, and all directions form the disc |b| <= n. Source: Harvey 1976, Light-Scattering
// Characteristics of Optical Surfaces, PhD thesis, University of Arizona; Harvey 2019,
// Understanding Surface Scatter, SPIE Press.
#pragma once
#include "math/vec.h"

namespace dg {

/// Lobe g(r) = (1 + (r / knee)^2)^(slope / 2): 1 at the centre, proportional to r^slope beyond the
/// knee.
struct HarveyShack {
    double knee = 0.01;
    double slope = -1.5;

    double at(double r) const;
    /// Integral over a disc of radius r about the centre.
    double within(double r) const;
    /// Radius of the disc with the share u of within(most).
    double radius(double u, double most) const;
    /// Integral over all directions (the disc of radius n) of a lobe with its centre at distance
    /// `offset` <= n from the normal.
    double over_directions(double offset, double n) const;

    /// Samples a direction in the disc of radius n: uniform azimuth about the lobe's centre, and a
    /// radius from the lobe.
    Vec2d sample(Vec2d middle, double n, Vec2d u) const;
    /// Density of sample() per unit of direction cosines squared; 0 outside of the disc.
    double pdf(Vec2d middle, double n, Vec2d at) const;
};

/// Throws an Error with `where` unless 1e-4 <= knee <= 1 and -4 <= slope <= -0.5.
void check_lobe(const HarveyShack& lobe, const char* where);

/// Total integrated scatter: fraction of the reflected or refracted light that surface roughness
/// scatters out of the specular direction. `step` is the optical path per unit of height: |n
/// cos(theta) - n' cos(theta')| for refraction, 2 n cos(theta) for reflection. The RMS roughness
/// counts only spatial wavelengths longer than the light's wavelength. Source: Harvey, Schroeder,
/// Choi and Duparre 2012, Total integrated scatter from surfaces with arbitrary roughness,
/// correlation widths, and incident angles, Opt. Eng. 51(1).
double total_integrated_scatter(double rms_nm, double step, double wavelength_nm);

}  // namespace dg
