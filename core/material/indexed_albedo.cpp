#include "material/indexed_albedo.h"

namespace dg {

IndexedAlbedo::Row IndexedAlbedo::row(float n, float alpha) const {
    const float ratio = std::clamp((n - 1) / (n + 1), 0.f, kLargestRatio) / kLargestRatio * (kIndices - 1);
    const float rough = std::sqrt(std::clamp(alpha, 0.f, 1.f)) * (kRoughnesses - 1);
    const int k = std::min(static_cast<int>(ratio), kIndices - 2);
    const int r = std::min(static_cast<int>(rough), kRoughnesses - 2);
    const auto& v = values;
    const auto& m = means;
    Row row{{{v[k][r], v[k][r + 1]}, {v[k + 1][r], v[k + 1][r + 1]}},
            ratio - static_cast<float>(k),
            rough - static_cast<float>(r)};
    row.mean = lerp(row.index_share, lerp(row.roughness_share, m[k][r], m[k][r + 1]),
                    lerp(row.roughness_share, m[k + 1][r], m[k + 1][r + 1]));
    return row;
}

LobeAlbedo IndexedAlbedo::Row::at(float cosine) const {
    const float x = std::sqrt(std::clamp(cosine, 0.f, 1.f)) * (kAngles - 1);
    const int i = std::min(static_cast<int>(x), kAngles - 2);
    const float t = x - static_cast<float>(i);
    const auto along = [&](int k) {
        const LobeAlbedo *low = corners[k][0], *high = corners[k][1];
        return lerp(roughness_share, lerp(t, low[i], low[i + 1]), lerp(t, high[i], high[i + 1]));
    };
    return lerp(index_share, along(0), along(1));
}

}  // namespace dg
