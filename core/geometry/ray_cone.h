// ray_cone.h -- how much of the scene one ray stands for: a cone around it, of which the
// width at a hit says over what a texture may be averaged.
// Source: Akenine-Moller et al. 2019, Texture Level of Detail Strategies for Real-Time Ray
// Tracing (Ray Tracing Gems, chapter 20). Through mirrors and glass the width follows the
// paraxial equations, as the height of a ray in a lens does.
#pragma once
#include <cmath>

namespace dg {

/// The share of a pixel, and of a BSDF's lobe, that a cone covers. Many samples fill the
/// pixel, so a cone as wide as the pixel would blur a converged picture twice.
/// How they were chosen: docs/textures.md.
inline constexpr float kConeShare = 0.5f;
inline constexpr float kLobeShare = 0.1f;

/// Both 0: a ray of no width, which stays so; textures are then read at full resolution.
struct RayCone {
    float width = 0;   // m across the ray, where it starts; negative beyond a focus
    float spread = 0;  // growth of the width per m

    bool empty() const { return width == 0 && spread == 0; }
    RayCone after(float t) const { return {width + spread * t, spread}; }

    /// `curvature` in 1/m as the ray meets it: positive where the surface bulges toward it.
    RayCone reflected(float curvature) const {
        return {width, spread + 2 * curvature * width};
    }
    /// `eta` = index behind the surface / index before it; 1 bends nothing.
    RayCone refracted(float curvature, float eta) const {
        return {width, (spread - (eta - 1) * curvature * width) / eta};
    }
    /// Into a lobe: 1 / pdf is the solid angle that a sample of this density stands for.
    RayCone scattered(float pdf) const {
        return {std::abs(width), std::abs(spread) + kLobeShare / std::sqrt(pdf)};
    }
};

}  // namespace dg
