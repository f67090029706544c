// ray_cone.h -- ray cones: the width at a hit is the filter width of textures. Source:
// Akenine-Moller et al. 2019, Texture Level of Detail Strategies for Real-Time Ray Tracing (Ray
// Tracing Gems, chapter 20). At mirrors and refractive surfaces the width follows the paraxial
// equations, like the height of a ray in a lens.
#pragma once
#include <cmath>

namespace dg {

/// Fraction of a pixel, and of a BSDF lobe, covered by a cone. A pixel has many samples, so a cone
/// as wide as the pixel would blur a converged image twice. The choice of the values:
/// docs/textures.md.
inline constexpr float kConeShare = 0.5f;
inline constexpr float kLobeShare = 0.1f;

/// Both 0: a ray without width, also after scattering; textures are read at full resolution.
struct RayCone {
    float width = 0;   // m across the ray at its origin; negative beyond a focus
    float spread = 0;  // growth of the width per m

    bool empty() const { return width == 0 && spread == 0; }
    RayCone after(float t) const { return {width + spread * t, spread}; }

    /// Cone after reflection. `curvature` in 1/m: positive for a surface that is convex toward the
    /// ray.
    RayCone reflected(float curvature) const {
        return {width, spread + 2 * curvature * width};
    }
    /// Cone after refraction. `eta` = index behind the surface / index in front of it.
    RayCone refracted(float curvature, float eta) const {
        return {width, (spread - (eta - 1) * curvature * width) / eta};
    }
    /// Cone after sampling a BSDF lobe: 1 / pdf is the solid angle of a sample.
    RayCone scattered(float pdf) const {
        return {std::abs(width), std::abs(spread) + kLobeShare / std::sqrt(pdf)};
    }
};

}  // namespace dg
