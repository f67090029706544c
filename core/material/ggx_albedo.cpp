#include "material/ggx_albedo.h"

namespace dg {

GgxAlbedo::Row GgxAlbedo::smooth_row() {
    // Mean of (1 - c)^5 with weight 2 c: 2 B(2, 6) = 1 / 21.
    return {nullptr, nullptr, 0, {20 / 21.f, 1 / 21.f, 1 / 21.f, 1}};
}

GgxAlbedo::Row GgxAlbedo::row(float roughness) const {
    const float x = (roughness > 0 ? std::min(roughness, 1.f) : 0.f) * (kRoughnesses - 1);
    const int i = std::min(static_cast<int>(x), kRoughnesses - 2);
    const float t = x - static_cast<float>(i);
    return {values[i], values[i + 1], t, lerp(t, means[i], means[i + 1])};
}

}  // namespace dg
