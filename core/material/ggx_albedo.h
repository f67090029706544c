// ggx_albedo.h -- directional albedo of a GGX lobe, tabulated over angle and roughness. With Schlick's
// F = F0 (1 - s) + F90 s the albedo is linear in F0 and F90, so two tables serve every interface: A = integral of (1 -
// s), B = integral of s over the lobe. A third, b, is the mean of s over the visible facets, so that F' = F0 (1 - b) +
// F90 b is the mean reflectance of a facet.
#pragma once
#include <algorithm>
#include <cmath>

#include "material/fresnel.h"
#include "spectrum/spectrum.h"

namespace dg {

/// A, B, b and 1 in the four lanes, to be weighted by four coefficients at once.
using LobeAlbedo = Spectrum;

/// The one table is baked::ggx (baked.h).
struct GgxAlbedo {
    static constexpr int kAngles = 32,
                         kRoughnesses = 24;  // uniform in sqrt(cos) and in sqrt(alpha)

    LobeAlbedo values[kRoughnesses][kAngles], means[kRoughnesses];

    /// Interpolated table row of a roughness; smooth surfaces use Schlick's curve itself.
    struct Row {
        const LobeAlbedo *low = nullptr, *high = nullptr;  // nullptr: smooth
        float blend = 0;
        LobeAlbedo mean;  // cosine-weighted mean of the interpolant

        LobeAlbedo at(float cos_angle) const {
            if (!low) {
                const float s = schlick(cos_angle);
                return {1 - s, s, s, 1};
            }
            const float x =
                std::sqrt(cos_angle > 0 ? std::min(cos_angle, 1.f) : 0.f) * (kAngles - 1);
            const int i = std::min(static_cast<int>(x), kAngles - 2);
            const float t = x - static_cast<float>(i);
            return lerp(blend, lerp(t, low[i], low[i + 1]),
                        lerp(t, high[i], high[i + 1]));
        }
    };
    static Row smooth_row();
    Row row(float roughness) const;
};

/// Weighted sum of the four lanes.
inline float weigh(LobeAlbedo albedo, Spectrum coefficients) {
    return 4 * (albedo * coefficients).average();
}

}  // namespace dg
