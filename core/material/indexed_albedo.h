// indexed_albedo.h -- albedo tables over index of refraction, roughness and angle.
#pragma once
#include "material/ggx_albedo.h"

namespace dg {

/// Table of four numbers by index, roughness and cosine, interpolated linearly in (n - 1) / (n + 1), sqrt(alpha) and
/// sqrt(cos).
struct IndexedAlbedo {
    static constexpr int kIndices = 16, kAngles = GgxAlbedo::kAngles, kRoughnesses = 16;
    static constexpr float kLargestIndex = 10, kLargestRatio = (kLargestIndex - 1) / (kLargestIndex + 1);

    LobeAlbedo values[kIndices][kRoughnesses][kAngles], means[kIndices][kRoughnesses];

    /// Interpolated table row of an index and a roughness.
    struct Row {
        const LobeAlbedo* corners[2][2] = {};   // per index and roughness
        float index_share = 0, roughness_share = 0;
        LobeAlbedo mean{0.f};   // cosine-weighted mean of the interpolant

        LobeAlbedo at(float cosine) const;
    };
    /// Requires n >= 1.
    Row row(float n, float alpha) const;
};

}  // namespace dg
