// ggx.h -- the GGX microfacet distribution with height-correlated Smith masking and
// shadowing. Sources: Walter et al. 2007, Microfacet Models for Refraction through Rough
// Surfaces (W07); Heitz 2014, Understanding the Masking-Shadowing Function, JCGT 3(2)
// (H14); Dupuy and Benyoub 2023, Sampling Visible GGX Normals with Spherical Caps (DB23).
// Formulas use dot products; a frame is built only for sampling.
#pragma once
#include <cmath>

#include "math/vec.h"

namespace dg {

/// (cos, sin) of 2 pi u for u in [0,1], from Taylor series of the half angle; error < 3e-7. Free of unpredictable
/// branches, and bit-identical with any C library.
inline Vec2f unit_circle(float u) {
    const float t = kPi * (u - 0.5f), t2 = t * t;
    const float s =
        t * (1 + t2 * (-1 / 6.f +
                       t2 * (1 / 120.f + t2 * (-1 / 5040.f +
                                               t2 * (1 / 362880.f - t2 / 39916800.f)))));
    const float c =
        1 + t2 * (-0.5f +
                  t2 * (1 / 24.f + t2 * (-1 / 720.f +
                                         t2 * (1 / 40320.f + t2 * (-1 / 3628800.f +
                                                                   t2 / 479001600.f)))));
    return {(s - c) * (s + c), -2 * s * c};
}

/// Samples a cosine-weighted direction around n; density cos / pi.
inline Vec3f sample_cosine(Vec3f n, Vec2f u) {
    const Vec2f d = unit_circle(u.x) * std::sqrt(u.y);
    return Frame::from_normal(n).to_world({d.x, d.y, std::sqrt(std::max(0.f, 1 - u.y))});
}

/// cos * sqrt(1 + alpha^2 tan^2). H14's Lambda is (ggx_slope / cos - 1) / 2.
inline float ggx_slope(float alpha2, float c) {
    return std::sqrt(alpha2 + (1 - alpha2) * c * c);
}

/// Samples a visible normal of GGX facets (world frame) from wo, which is above frame.z, with
/// the roughness alpha.x along frame.x and alpha.y along frame.y (DB23).
inline Vec3f sample_visible_normal(const Frame& frame, Vec3f wo, Vec2f alpha, Vec2f u) {
    const Vec3f v = frame.to_local(wo);
    const Vec3f hemi = normalize(Vec3f{alpha.x * v.x, alpha.y * v.y, v.z});
    const Vec2f circle = unit_circle(u.x);
    const float z = 1 - u.y * (1 + hemi.z);
    const float r = std::sqrt(std::max(0.f, 1 - z * z));
    const Vec3f c = Vec3f{r * circle.x, r * circle.y, z} + hemi;
    return frame.to_world(
        normalize(Vec3f{alpha.x * c.x, alpha.y * c.y, std::max(c.z, 1e-7f)}));
}
inline Vec3f sample_visible_normal(Vec3f n, Vec3f wo, float alpha, Vec2f u) {
    return sample_visible_normal(Frame::from_normal(n), wo, Vec2f{alpha, alpha}, u);
}

/// A facet that connects two directions, without its Fresnel factor.
struct Facet {
    float cos_h = 0;  // between wo and the facet's normal
    float f_cos = 0;  // f * |cos wi|
    float pdf = 0;    // density of wi for visible-normal sampling from wo
};

/// D of the unnormalised half vector h (W07 eq. 33). Narrow lobes need |n x h|, since 1 - cos^2 suffers from
/// cancellation.
inline float ggx_d(Vec3f n, Vec3f h, float h2, float alpha2) {
    const float cos_h = dot(n, h);
    const float d = (alpha2 * cos_h * cos_h + length_squared(cross(n, h))) / h2;
    return alpha2 / (kPi * d * d);
}

/// Isotropic facets.
struct RoundGgx {
    float alpha2;
    float d(Vec3f n, Vec3f h, float h2) const { return ggx_d(n, h, h2, alpha2); }
    float slope(Vec3f /*w*/, float cos_w) const { return ggx_slope(alpha2, cos_w); }
};

/// Anisotropic facets with separate roughness along `tangent` and across it. Sources: Walter et al. 2007 in the
/// stretched form of H14, section 5.4 and eq. 86.
struct StretchedGgx {
    Vec3f tangent, bitangent;
    float alpha_t, alpha_b;

    float d(Vec3f n, Vec3f h, float h2) const {
        const float t = dot(tangent, h) / alpha_t, b = dot(bitangent, h) / alpha_b;
        const float c = dot(n, h), q = (t * t + b * b + c * c) / h2;
        return 1 / (kPi * alpha_t * alpha_b * q * q);
    }
    float slope(Vec3f w, float cos_w) const {
        const float t = alpha_t * dot(tangent, w), b = alpha_b * dot(bitangent, w);
        return std::sqrt(t * t + b * b + cos_w * cos_w);
    }
    /// alpha of isotropic facets with the same masking of w (H14, section 5.4).
    float alpha_toward(Vec3f w) const {
        const float t = dot(tangent, w), b = dot(bitangent, w), r2 = t * t + b * b;
        if (!(r2 > 0)) return std::sqrt(alpha_t * alpha_b);
        return std::sqrt((alpha_t * alpha_t * t * t + alpha_b * alpha_b * b * b) / r2);
    }
};

/// Reflection: f cos = D G2 / (4 cos_o), pdf = D G1 / (4 cos_o) (W07 eq. 20, H14 eq. 99).
template <typename Ggx>
Facet reflecting_facet(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i,
                       const Ggx& ggx) {
    const Vec3f h = wo + wi;
    const float h2 = length_squared(h);
    const float d = ggx.d(n, h, h2);
    const float slope_o = ggx.slope(wo, cos_o), slope_i = ggx.slope(wi, cos_i);
    return {dot(wo, h) / std::sqrt(h2),
            d * cos_i / (2 * (cos_i * slope_o + cos_o * slope_i)),
            d / (2 * (cos_o + slope_o))};
}

/// Refraction from wo (above n) to wi (below), eta = index at wi / index at wo (W07 eq.
/// 16, 17, 21). Transports radiance: f carries 1 / eta^2. Empty if no facet connects the two.
template <typename Ggx>
Facet refracting_facet(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i,
                       const Ggx& ggx, float eta) {
    Vec3f h = wo + wi * eta;
    const float h2 = length_squared(h);
    if (h2 == 0) return {};
    h *= 1 / std::sqrt(h2);
    if (dot(n, h) < 0) h = -h;
    const float oh = dot(wo, h), ih = dot(wi, h);
    if (oh <= 0 || ih >= 0) return {};
    const float slope_o = ggx.slope(wo, cos_o), slope_i = ggx.slope(wi, cos_i);
    const float d = ggx.d(n, h, 1);
    const float root = eta * ih + oh;
    const float pdf = d * 2 * oh / (cos_o + slope_o) * (-ih * eta * eta / (root * root));
    const float masking =
        -cos_i * (cos_o + slope_o) / (-cos_i * slope_o + cos_o * slope_i);
    return {oh, pdf * masking / (eta * eta), pdf};
}

inline Vec3f reflect(Vec3f wo, Vec3f n) {
    return n * (2 * dot(wo, n)) - wo;
}

/// Refracts wo, which is above n and not totally reflected; eta = index beyond / index at wo.
inline Vec3f refract(Vec3f wo, Vec3f n, float eta) {
    const float cos_o = dot(wo, n);
    const float cos_t = std::sqrt(std::max(0.f, 1 - (1 - cos_o * cos_o) / (eta * eta)));
    return normalize(n * (cos_o / eta - cos_t) - wo * (1 / eta));
}

}  // namespace dg
