// quadrature.cpp -- GGX and Beckmann over their visible normals, the sheen over the hemisphere.
#include "material/bake/quadrature.h"

#include "material/beckmann.h"
#include "material/fresnel.h"
#include "material/ggx.h"

namespace dg::bake {
namespace {

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

/// Midpoint rule in the two random numbers of the sampler, over half a circle; the other half is symmetric.
LobeAlbedo integrate_ggx(float cos_o, float alpha) {
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

/// Isotropic facets around z. By symmetry, random numbers with `u.x` below 0.5 suffice.
struct Ggx {
    float alpha;
    float slope(float cosine) const { return ggx_slope(alpha * alpha, cosine); }
    Vec3f visible(Vec3f wo, Vec2f u) const { return sample_visible_normal({0, 0, 1}, wo, alpha, u); }
};
struct Beckmann {
    float alpha;
    float slope(float cosine) const { return beckmann_slope(alpha, cosine); }
    Vec3f visible(Vec3f wo, Vec2f u) const {
        return sample_visible_beckmann({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, wo, {alpha, alpha}, {u.y, u.x});
    }
};

/// Height-correlated G2 / G1 of a facet that connects two directions.
float passed(float cos_o, float slope_o, float cos_i, float slope_i) {
    return cos_i * (cos_o + slope_o) / (cos_i * slope_o + cos_o * slope_i);
}

float curve_of(float exact, float f0) { return f0 < 1 ? std::max(0.f, exact - f0) / (1 - f0) : 0.f; }

/// Unblocked light of a facet on both sides, for eta = index beyond / index here.
struct Returned {
    float reflected = 0, facets = 0, transmitted = 0, exact = 1;
};
template <typename Round>
Returned returned(Vec3f wo, Vec3f h, Round round, float eta) {
    Returned r;
    const float cos_o = wo.z, slope_o = round.slope(cos_o), cos_h = dot(wo, h);
    r.exact = fresnel_dielectric(cos_h, eta);
    const float up = reflect(wo, h).z;
    if (up > 0) r.facets = passed(cos_o, slope_o, up, round.slope(up));
    r.reflected = r.exact * r.facets;
    if (r.exact >= 1) return r;
    const float down = -refract(wo, h, eta).z;
    if (down > 0) r.transmitted = (1 - r.exact) * passed(cos_o, slope_o, down, round.slope(down));
    return r;
}

/// Midpoint rule as in integrate_ggx.
constexpr int kAzimuths = 8, kCaps = 48;
template <typename Round, typename What>
void for_visible_facets(Vec3f wo, Round round, What what) {
    for (int j = 0; j < kAzimuths; ++j) {
        for (int i = 0; i < kCaps; ++i) {
            const Vec2f u{(static_cast<float>(j) + 0.5f) / (2 * kAzimuths), (static_cast<float>(i) + 0.5f) / kCaps};
            what(round.visible(wo, u));
        }
    }
}

template <typename Round>
LobeAlbedo integrate_glass(float cos_o, float alpha, float n) {
    if (alpha == 0) return {0, 0, curve_of(fresnel_dielectric(cos_o, n), normal_reflectance(n)), 1};
    const Vec3f wo{std::sqrt(std::max(0.f, 1 - cos_o * cos_o)), 0, cos_o};
    const float f0 = normal_reflectance(n);
    double thin = 0, dense = 0, curve = 0, facets = 0;
    const Round round{alpha};
    for_visible_facets(wo, round, [&](Vec3f h) {
        const Returned outside = returned(wo, h, round, n), inside = returned(wo, h, round, 1 / n);
        thin += 1 - (outside.reflected + outside.transmitted);
        dense += 1 - (inside.reflected + inside.transmitted);
        curve += curve_of(outside.exact, f0) * outside.facets;
        facets += outside.facets;
    });
    const double scale = 1.0 / (kAzimuths * kCaps);
    return {static_cast<float>(std::max(0.0, thin * scale)), static_cast<float>(std::max(0.0, dense * scale)),
            static_cast<float>(curve * scale), static_cast<float>(facets * scale)};
}

/// A metal of reflectance 1 under a smooth coat: unblocked light of its facets minus light that leaves the coat.
template <typename Round>
LobeAlbedo integrate_caught(float cos_o, float alpha, float n) {
    if (alpha == 0) return 0.f;
    const auto inside = [&](float c) { return std::sqrt(1 - (1 - c * c) / (n * n)); };
    const auto reflected = [&](float c) { return fresnel_dielectric(c, n); };
    const Round round{alpha};
    const float c = inside(cos_o), slope_o = round.slope(c), e_o = reflected(cos_o);
    const Vec3f wo{std::sqrt(std::max(0.f, 1 - c * c)), 0, c};
    double caught = 0;
    for_visible_facets(wo, round, [&](Vec3f h) {
        const float up = reflect(wo, h).z, sin2 = (1 - up * up) * n * n;
        if (up <= 0) return;
        const float facets = passed(c, slope_o, up, round.slope(up));
        const float e_i = sin2 < 1 ? reflected(std::sqrt(1 - sin2)) : 1.f;
        const float leaves = e_i < 1 ? (1 - e_i) / (1 - std::min(e_o, e_i)) : 0.f;
        caught += facets * (1 - leaves);
    });
    const float share = static_cast<float>(std::max(0.0, caught / (kAzimuths * kCaps)));
    return {share, share * (1 - e_o), 0, 0};
}

/// Fills a table from a function of cosine, alpha and n.
template <typename Integrand>
IndexedAlbedo tabulated(Integrand integrand) {
    IndexedAlbedo table;
    for (int k = 0; k < table.kIndices; ++k) {
        const float ratio = table.kLargestRatio * static_cast<float>(k) / (table.kIndices - 1);
        const float n = (1 + ratio) / (1 - ratio);
        for (int r = 0; r < table.kRoughnesses; ++r) {
            const float roughness = static_cast<float>(r) / (table.kRoughnesses - 1);
            for (int i = 0; i < table.kAngles; ++i) {
                const float x = static_cast<float>(i) / (table.kAngles - 1);
                table.values[k][r][i] = integrand(std::max(x * x, 1e-4f), roughness * roughness, n);
            }
            table.means[k][r] = cosine_mean(table.values[k][r]);
        }
    }
    return table;
}

constexpr int kRings = 48, kTurns = 24;

/// Roughness of a table row, uniform between the smallest roughness and 1.
float roughness_of(int row) {
    constexpr float kStep = (1 - kLeastSheenRoughness) / (CharlieAlbedo::kRoughnesses - 1);
    return kLeastSheenRoughness + static_cast<float>(row) * kStep;
}

/// Integral of f cos over the hemisphere, by the midpoint rule in sqrt(cos) and in azimuth over half a turn.
float integrate_charlie(float cos_o, float alpha, const float (&lambda)[kRings]) {
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

GgxAlbedo ggx() {
    GgxAlbedo table;
    for (int r = 0; r < table.kRoughnesses; ++r) {
        const float roughness = static_cast<float>(r) / (table.kRoughnesses - 1);
        for (int i = 0; i < table.kAngles; ++i) {
            const float x = static_cast<float>(i) / (table.kAngles - 1), cos_o = x * x, s = schlick(cos_o);
            table.values[r][i] = r == 0 ? LobeAlbedo{1 - s, s, s, 1}
                                        : integrate_ggx(std::max(cos_o, 1e-4f), roughness * roughness);
        }
        table.means[r] = cosine_mean(table.values[r]);
    }
    return table;
}

CharlieAlbedo charlie() {
    CharlieAlbedo table;
    for (int r = 0; r < table.kRoughnesses; ++r) {
        const float alpha = charlie_alpha(roughness_of(r));
        float lambda[kRings];
        for (int i = 0; i < kRings; ++i) {
            const float x = (static_cast<float>(i) + 0.5f) / kRings;
            lambda[i] = charlie_lambda(x * x, alpha);
        }
        for (int i = 0; i < table.kAngles; ++i) {
            const float x = static_cast<float>(i) / (table.kAngles - 1);
            table.values[r][i] = integrate_charlie(std::max(x * x, 1e-4f), alpha, lambda);
        }
    }
    return table;
}

IndexedAlbedo glass(Distribution d) {
    return tabulated(d == Distribution::ggx ? integrate_glass<Ggx> : integrate_glass<Beckmann>);
}

IndexedAlbedo caught(Distribution d) {
    return tabulated(d == Distribution::ggx ? integrate_caught<Ggx> : integrate_caught<Beckmann>);
}

}  // namespace dg::bake
