// charlie.h -- the sheen of cloth, with fibres around the normal. Distribution and visibility of Estevez and Kulla
// 2017, Production Friendly Microfacet Sheen BRDF, as in KHR_materials_sheen, with alpha = roughness^2:
//   D = (2 + 1 / alpha) sin(h)^(1 / alpha) / (2 pi)
//   V = 1 / ((1 + Lambda(wo) + Lambda(wi)) 4 cos_o cos_i)
// With the fitted Lambda, narrow lobes gain energy at grazing angles, up to a factor of four. So f is divided by the
// larger of both directions' albedos if it exceeds 1, which is reciprocal and loses no energy elsewhere.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace dg {

/// Smallest roughness: narrower lobes are too narrow for the table, and reflect almost nothing.
inline constexpr float kLeastSheenRoughness = 0.07f;

inline float charlie_alpha(float roughness) {
    const float r = std::max(roughness, kLeastSheenRoughness);
    return r * r;
}

/// D of an unnormalised half vector h.
inline float charlie_d(Vec3f n, Vec3f h, float alpha) {
    const float sin2 = std::min(1.f, length_squared(cross(n, h)) / length_squared(h));
    return (2 + 1 / alpha) * std::pow(sin2, 0.5f / alpha) / (2 * kPi);
}

/// Lambda of the masking (Estevez and Kulla, section 3).
float charlie_lambda(float cos_angle, float alpha);

/// Directional albedo of f = D V, before the limit of 1. The one table is baked::charlie (baked.h).
struct CharlieAlbedo {
    static constexpr int kAngles = 32, kRoughnesses = 32;  // uniform in sqrt(cos)

    float values[kRoughnesses][kAngles];

    struct Row {
        const float *low = nullptr, *high = nullptr;
        float blend = 0;

        float at(float cos_angle) const {
            const float c = std::clamp(std::abs(cos_angle), 0.f, 1.f);
            const float x = std::sqrt(c) * (kAngles - 1);
            const int i = std::min(static_cast<int>(x), kAngles - 2);
            const float t = x - static_cast<float>(i);
            const float a = low[i] + t * (low[i + 1] - low[i]);
            return a + blend * (high[i] + t * (high[i + 1] - high[i]) - a);
        }
    };
    Row row(float roughness) const;
};

}  // namespace dg
