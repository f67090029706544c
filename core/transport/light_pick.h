// light_pick.h -- direct light by one of several light samples, picked by what each would bring if nothing were in its
// way: the tree that draws them knows where a point is, but neither its normal nor how it reflects.
//
// Samples x_i, i < n, of density p; g is the light that one would bring without its shadow, with its share w against
// BSDF sampling. One is picked in proportion to g_i / p_i, and counts (f L V w)(x) / g(x) * sum g_i / p_i / n. So only
// shadows and what the sum varies by are left as noise. Source: Talbot, Cline and Egbert 2005, Importance Resampling
// for Global Illumination, EGSR. w is the power heuristic (Veach 1997, 9.2.4) with n p in place of p, as n tries find
// what one seldom does; any w would do that BSDF sampling knows as well.
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "transport/walk/direct_light.h"

namespace dg {

/// How many light samples a vertex picks one of: one where there is little to choose from, and fewer where the lens does
/// not look, straight or by mirrors. CPU time x error of bench/first_picture.py is the same from four to eight.
inline int light_tries(const LightSet& lights, bool in_view) {
    constexpr std::size_t kFew = 4;
    if (lights.empty()) return 0;
    return lights.choices() <= kFew ? 1 : in_view ? int(LightSet::kMostSamples) : 2;
}

class LightPick {
  public:
    struct Random {
        float select;   // which lights
        Vec2f place;    // where on them
        float pick;     // which of them
    };
    /// One of `tries` samples. `shared`: whether BSDF sampling finds the same light. `evaluate` gives the BSDF toward a
    /// light, `throughput` how its wavelengths count.
    template <typename Evaluate>
    static std::optional<DirectLight> pick(const Scene& scene, const SurfaceHit& hit, const Wavelengths& wavelengths,
                                           int tries, bool shared, const Random& u, Spectrum throughput,
                                           const Evaluate& evaluate);

  private:
    static constexpr std::size_t kMost = LightSet::kMostSamples;
    std::array<LightSample, kMost> lights_;
    std::array<Evaluation, kMost> seen_;
    std::array<float, kMost> worth_, weight_;   // g / p; w / p
};

template <typename Evaluate>
std::optional<DirectLight> LightPick::pick(const Scene& scene, const SurfaceHit& hit,
                                           const Wavelengths& wavelengths, int tries, bool shared, const Random& u,
                                           Spectrum throughput, const Evaluate& evaluate) {
    LightPick all;
    scene.lights().sample_several(u.select, u.place, hit.position, hit.time, wavelengths,
                                  std::span(all.lights_).first(std::size_t(tries)));
    float sum = 0;
    for (int i = 0; i < tries; ++i) {
        const LightSample& light = all.lights_[i];
        all.worth_[i] = 0;
        if (!(light.pdf > 0)) continue;
        const Evaluation& e = all.seen_[i] = evaluate(light.wi);
        const bool alone = light.delta || !shared;
        all.weight_[i] = (alone ? 1 : power_heuristic(float(tries) * light.pdf, e.pdf)) / light.pdf;
        all.worth_[i] = (throughput * e.f_cos * light.radiance).average() * all.weight_[i];
        sum += all.worth_[i];
    }
    if (!(sum > 0) || !std::isfinite(sum)) return std::nullopt;
    float left = u.pick * sum;
    int chosen = -1;
    for (int i = 0; i < tries && (chosen < 0 || left >= 0); ++i)
        if (all.worth_[i] > 0) chosen = i, left -= all.worth_[i];
    const float share = sum / (float(tries) * all.worth_[chosen]);
    DirectLight found{all.lights_[chosen], all.seen_[chosen], all.weight_[chosen] * share};
    if (found.light.uneven) scene.resolve(found.light, hit.time, wavelengths);
    return found;
}

}  // namespace dg
