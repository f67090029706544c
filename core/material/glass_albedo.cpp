// glass_albedo.cpp -- the tables of glass_albedo.h by quadrature over the visible normals.
#include "material/glass_albedo.h"

#include "material/beckmann.h"
#include "material/ggx_albedo.h"

namespace dg {
namespace {

GlassLobes to_lobes(LobeAlbedo a) { return {a[0], a[1], a[2], a[3]}; }

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

/// Midpoint rule in the two random numbers of the sampler, over half a circle; the other half is symmetric.
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

template <typename Round>
const IndexedAlbedo& glass_table() {
    static const IndexedAlbedo table(integrate_glass<Round>);
    return table;
}
const IndexedAlbedo& glass_table(Distribution d) {
    return d == Distribution::ggx ? glass_table<Ggx>() : glass_table<Beckmann>();
}
template <typename Round>
const IndexedAlbedo& caught_table() {
    static const IndexedAlbedo table(integrate_caught<Round>);
    return table;
}
const IndexedAlbedo& caught_table(Distribution d) {
    return d == Distribution::ggx ? caught_table<Ggx>() : caught_table<Beckmann>();
}

/// Duntley's closed form, which cancels for n near 1.
double mean_in_closed_form(double n) {
    const double n2 = n * n, n4 = n2 * n2, plus = n2 + 1, minus = n2 - 1, fourth = n4 - 1;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * minus * minus / (plus * plus * plus) * std::log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / (plus * fourth) + 8 * n4 * (n4 + 1) / (plus * fourth * fourth) * std::log(n);
}

}  // namespace

float mean_fresnel(float n) {
    constexpr double kNearest = 1.01;   // below, terms of 1 / (n - 1)^2 suffer from cancellation
    if (n >= kNearest) return static_cast<float>(mean_in_closed_form(n));
    return static_cast<float>(mean_in_closed_form(kNearest) * (std::max(n, 1.f) - 1) / (kNearest - 1));
}

GlassAlbedo::GlassAlbedo(float n, const Facets& facets)
    : n_(n), facets_(facets.ggx), distribution_(facets.distribution),
      row_(glass_table(distribution_).row(n, facets_.alpha_t)), mean_(to_lobes(row_.mean)) {
    if (facets_.alpha_t == facets_.alpha_b) return;
    constexpr int kTurns = 8;   // in a quarter turn
    LobeAlbedo sum(0.f);
    for (int i = 0; i < kTurns; ++i) {
        const Vec2f d = unit_circle((static_cast<float>(i) + 0.5f) / (4 * kTurns));
        const Vec3f w = facets_.tangent * d.x + facets_.bitangent * d.y;
        sum += glass_table(distribution_).row(n, facets_.alpha_toward(w)).mean;
    }
    mean_ = to_lobes(sum / static_cast<float>(kTurns));
}

GlassLobes GlassAlbedo::toward(Vec3f w, float cosine) const {
    if (facets_.alpha_t == facets_.alpha_b) return to_lobes(row_.at(cosine));
    return to_lobes(glass_table(distribution_).row(n_, facets_.alpha_toward(w)).at(cosine));
}

CaughtBelow::CaughtBelow(float n, float alpha, Distribution distribution)
    : row(caught_table(distribution).row(n, alpha)) {}

float mean_passed(float alpha, Distribution distribution) {
    if (distribution == Distribution::ggx) return weigh(GgxAlbedo::instance().row(std::sqrt(alpha)).mean, {1, 1, 0, 0});
    return glass_table<Beckmann>().row(1, alpha).mean[3];   // the same for every index
}

}  // namespace dg
