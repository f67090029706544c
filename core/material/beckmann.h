// beckmann.h -- the Beckmann microfacet distribution with height-correlated Smith masking and shadowing; an alternative
// to GGX in the templates of ggx.h. Its slopes are normally distributed, so lobes lack the long tails of GGX.
// Sources: Walter et al. 2007, Microfacet Models for Refraction through Rough Surfaces, eq. 25; Heitz 2014,
// Understanding the Masking-Shadowing Function, JCGT 3(2), eq. 66, 72 and section 5.4.
#pragma once
#include "math/vec.h"

namespace dg {

/// Error function, absolute error 1.5e-7 (Abramowitz and Stegun 1964, 7.1.26); `gauss` is exp(-x^2).
float error_function(float x, float gauss);
/// Inverse error function on (-1, 1), relative error 4e-7 (Giles 2012, Approximating the erfinv function).
float inverse_error_function(float y);

/// Anisotropic facets with separate roughness along `tangent` and across it.
struct StretchedBeckmann {
    Vec3f tangent, bitangent;
    float alpha_t, alpha_b;

    /// D of the unnormalised half vector h.
    float d(Vec3f n, Vec3f h, float h2) const;
    /// cos (1 + 2 Lambda), as in ggx.h.
    float slope(Vec3f w, float cos_w) const;
};

/// cos (1 + 2 Lambda) at a cosine, for isotropic facets.
float beckmann_slope(float alpha, float cosine);

/// Samples a visible normal of Beckmann facets (world frame) from wo, which is above frame.z, with the roughness
/// alpha.x along frame.x and alpha.y along frame.y.
Vec3f sample_visible_beckmann(const Frame& frame, Vec3f wo, Vec2f alpha, Vec2f u);

}  // namespace dg
