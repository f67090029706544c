// charlie.cpp -- masking of the sheen, and rows of its table.
#include "material/charlie.h"

namespace dg {
namespace {

/// The fit l(x) of the paper, table 1: blended by (1 - alpha)^2.
float fit(float x, float alpha) {
    const float t = (1 - alpha) * (1 - alpha);
    const auto mix = [&](float rough, float smooth) {
        return rough + t * (smooth - rough);
    };
    const float a = mix(21.5473f, 25.3245f), b = mix(3.82987f, 3.32435f);
    const float c = mix(0.19823f, 0.16801f), d = mix(-1.97760f, -1.27393f);
    const float e = mix(-4.32054f, -4.85967f);
    return a / (1 + b * std::pow(x, c)) + d * x + e;
}

}  // namespace

float charlie_lambda(float cos_angle, float alpha) {
    const float c = std::clamp(cos_angle, 0.f, 1.f);
    return c < 0.5f ? std::exp(fit(c, alpha))
                    : std::exp(2 * fit(0.5f, alpha) - fit(1 - c, alpha));
}

CharlieAlbedo::Row CharlieAlbedo::row(float roughness) const {
    const float r = std::clamp(roughness, kLeastSheenRoughness, 1.f);
    const float x = (r - kLeastSheenRoughness) / (1 - kLeastSheenRoughness) *
                    (kRoughnesses - 1);
    const int i = std::min(static_cast<int>(x), kRoughnesses - 2);
    return {values[i], values[i + 1], x - static_cast<float>(i)};
}

}  // namespace dg
