// charlie.cpp -- masking and albedo table of the sheen.
#include "material/charlie.h"

namespace dg {
namespace {

constexpr int kRings = 48, kTurns = 24;

/// Roughness of a table row, uniform between the smallest roughness and 1.
float roughness_of(int row) {
    constexpr float kStep = (1 - kLeastSheenRoughness) / (CharlieAlbedo::kRoughnesses - 1);
    return kLeastSheenRoughness + static_cast<float>(row) * kStep;
}

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

/// Integral of f cos over the hemisphere, by the midpoint rule in sqrt(cos) and in azimuth over half a turn.
float integrate(float cos_o, float alpha, const float (&lambda)[kRings]) {
    const Vec3f n{0, 0, 1}, wo{std::sqrt(std::max(0.f, 1 - cos_o * cos_o)), 0, cos_o};
    const float lambda_o = charlie_lambda(cos_o, alpha);
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / kRings, cos_i = x * x;
        const float r = std::sqrt(1 - cos_i * cos_i);
        const float masking = x / ((1 + lambda_o + lambda[i]) * 4 * cos_o);
        for (int j = 0; j < kTurns; ++j) {
            const float phi = kPi * (static_cast<float>(j) + 0.5f) / kTurns;
            const Vec3f wi{r * std::cos(phi), r * std::sin(phi), cos_i};
            sum += charlie_d(n, wo + wi, alpha) * masking;
        }
    }
    return static_cast<float>(sum * 2 * 2 * kPiD / (kRings * kTurns));
}

}  // namespace

float charlie_lambda(float cos_angle, float alpha) {
    const float c = std::clamp(cos_angle, 0.f, 1.f);
    return c < 0.5f ? std::exp(fit(c, alpha))
                    : std::exp(2 * fit(0.5f, alpha) - fit(1 - c, alpha));
}

CharlieAlbedo::CharlieAlbedo() {
    for (int r = 0; r < kRoughnesses; ++r) {
        const float alpha = charlie_alpha(roughness_of(r));
        float lambda[kRings];
        for (int i = 0; i < kRings; ++i) {
            const float x = (static_cast<float>(i) + 0.5f) / kRings;
            lambda[i] = charlie_lambda(x * x, alpha);
        }
        for (int i = 0; i < kAngles; ++i) {
            const float x = static_cast<float>(i) / (kAngles - 1);
            table_[r][i] = integrate(std::max(x * x, 1e-4f), alpha, lambda);
        }
    }
}

const CharlieAlbedo& CharlieAlbedo::instance() {
    static const CharlieAlbedo table;
    return table;
}

CharlieAlbedo::Row CharlieAlbedo::row(float roughness) const {
    const float r = std::clamp(roughness, kLeastSheenRoughness, 1.f);
    const float x = (r - kLeastSheenRoughness) / (1 - kLeastSheenRoughness) *
                    (kRoughnesses - 1);
    const int i = std::min(static_cast<int>(x), kRoughnesses - 2);
    return {table_[i], table_[i + 1], x - static_cast<float>(i)};
}

}  // namespace dg
