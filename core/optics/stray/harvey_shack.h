// harvey_shack.h -- the lobe of light that smooth surfaces scatter about their mirror image, or about what they
// refract: a shape that depends on nothing but the distance from its middle, in direction cosines.
//
// Direction cosines here are the part of n x direction that lies in the surface: sin(theta) in air. Refraction
// and reflection leave them as they are, so the middle of the lobe is where the light comes from, and all
// directions lie in the disc |b| <= n. Source: Harvey 1976, Light-Scattering Characteristics of Optical
// Surfaces, PhD thesis, University of Arizona; Harvey 2019, Understanding Surface Scatter, SPIE Press.
#pragma once
#include "math/vec.h"

namespace dg {

/// g(r) = (1 + (r / knee)^2)^(slope / 2): 1 in the middle, falling as r^slope beyond the knee.
struct HarveyShack {
    double knee = 0.01;
    double slope = -1.5;

    double at(double r) const;
    /// Integral over a disc of radius r about the middle.
    double within(double r) const;
    /// Distance up to which lies the share u of within(most).
    double radius(double u, double most) const;
    /// Integral over the directions, a disc of radius n, of a lobe whose middle lies `offset` <= n from theirs.
    double over_directions(double offset, double n) const;

    /// A direction of the disc of radius n: evenly around the middle, and by the shape along the way out.
    Vec2d sample(Vec2d middle, double n, Vec2d u) const;
    /// Density of sample() per unit of the disc; 0 outside.
    double pdf(Vec2d middle, double n, Vec2d at) const;
};

/// Throws Error naming `where`: a knee of 1e-4 to 1, a slope of -4 to -0.5.
void check_lobe(const HarveyShack& lobe, const char* where);

/// Total integrated scatter: the share of reflected or refracted light that a surface of this RMS roughness
/// takes from its mirror image or refracted ray and scatters. `step`: |n cos(theta) - n' cos(theta')| for what is
/// refracted, 2 n cos(theta) for what is reflected: the path that a height of 1 adds. The roughness is that of
/// the waves longer than the light's. Source: Harvey, Schroeder, Choi and Duparre 2012, Total integrated scatter
/// from surfaces with arbitrary roughness, correlation widths, and incident angles, Opt. Eng. 51(1).
double total_integrated_scatter(double rms_nm, double step, double wavelength_nm);

}  // namespace dg
