// ggx_albedo.cpp -- the tables of ggx_albedo.h by quadrature over the visible normals.
#include "material/ggx_albedo.h"

#include "material/ggx.h"

namespace dg {
namespace {

/// Midpoint rule in the two random numbers of the sampler, over half a circle; the other half is symmetric.
LobeAlbedo integrate(float cos_o, float alpha) {
    constexpr int kAzimuths = 12, kCaps = 48;
    const Vec3f n{0, 0, 1}, wo{std::sqrt(std::max(0.f, 1 - cos_o * cos_o)), 0, cos_o};
    const float alpha2 = alpha * alpha, slope_o = ggx_slope(alpha2, cos_o);
    double a = 0, b = 0, facets = 0;
    for (int j = 0; j < kAzimuths; ++j) {
        for (int i = 0; i < kCaps; ++i) {
            const Vec2f u{(static_cast<float>(j) + 0.5f) / (2 * kAzimuths),
                          (static_cast<float>(i) + 0.5f) / kCaps};
            const Vec3f h = sample_visible_normal(n, wo, alpha, u);
            const float s = schlick(dot(wo, h)), cos_i = reflect(wo, h).z;
            facets += s;
            if (cos_i <= 0) continue;
            const float slope_i = ggx_slope(alpha2, cos_i);
            const float masking =
                cos_i * (cos_o + slope_o) / (cos_i * slope_o + cos_o * slope_i);
            a += (1 - s) * masking;
            b += s * masking;
        }
    }
    const double scale = 1.0 / (kAzimuths * kCaps);
    return {static_cast<float>(a * scale), static_cast<float>(b * scale),
            static_cast<float>(facets * scale), 1};
}

}  // namespace

// With x = sqrt(cos) the weight is 4 x^3 dx. The integrand has degree 4 in each cell, for which three Gauss points are
// exact.
LobeAlbedo cosine_mean(const LobeAlbedo* values) {
    constexpr float kNode = 0.77459667f, kOuter = 5 / 18.f, kInner = 8 / 18.f;
    LobeAlbedo sum(0.f);
    constexpr float kStep = 1.f / (GgxAlbedo::kAngles - 1);
    for (int i = 0; i + 1 < GgxAlbedo::kAngles; ++i) {
        for (int k = -1; k <= 1; ++k) {
            const float t = 0.5f + 0.5f * kNode * static_cast<float>(k);
            const float x = (static_cast<float>(i) + t) * kStep;
            const float w = (k == 0 ? kInner : kOuter) * kStep * 4 * x * x * x;
            sum += lerp(t, values[i], values[i + 1]) * w;
        }
    }
    return sum;
}

GgxAlbedo::GgxAlbedo() {
    for (int r = 0; r < kRoughnesses; ++r) {
        const float roughness = static_cast<float>(r) / (kRoughnesses - 1);
        for (int i = 0; i < kAngles; ++i) {
            const float x = static_cast<float>(i) / (kAngles - 1), cos_o = x * x;
            table_[r][i] = r == 0
                               ? smooth_row().at(cos_o)
                               : integrate(std::max(cos_o, 1e-4f), roughness * roughness);
        }
        mean_[r] = cosine_mean(table_[r]);
    }
}

const GgxAlbedo& GgxAlbedo::instance() {
    static const GgxAlbedo table;
    return table;
}

GgxAlbedo::Row GgxAlbedo::smooth_row() {
    // Mean of (1 - c)^5 with weight 2 c: 2 B(2, 6) = 1 / 21.
    return {nullptr, nullptr, 0, {20 / 21.f, 1 / 21.f, 1 / 21.f, 1}};
}

GgxAlbedo::Row GgxAlbedo::row(float roughness) const {
    const float x = (roughness > 0 ? std::min(roughness, 1.f) : 0.f) * (kRoughnesses - 1);
    const int i = std::min(static_cast<int>(x), kRoughnesses - 2);
    const float t = x - static_cast<float>(i);
    return {table_[i], table_[i + 1], t, lerp(t, mean_[i], mean_[i + 1])};
}

}  // namespace dg
