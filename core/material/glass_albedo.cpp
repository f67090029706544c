#include "material/glass_albedo.h"

#include "material/baked.h"

namespace dg {
namespace {

GlassLobes to_lobes(LobeAlbedo a) { return {a[0], a[1], a[2], a[3]}; }

const IndexedAlbedo& glass_table(Distribution d) {
    return d == Distribution::ggx ? baked::glass_ggx : baked::glass_beckmann;
}
const IndexedAlbedo& caught_table(Distribution d) {
    return d == Distribution::ggx ? baked::caught_ggx : baked::caught_beckmann;
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
    if (distribution == Distribution::ggx) return weigh(baked::ggx.row(std::sqrt(alpha)).mean, {1, 1, 0, 0});
    return baked::glass_beckmann.row(1, alpha).mean[3];   // the same for every index
}

}  // namespace dg
