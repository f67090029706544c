// light_pick.h -- resampled direct lighting: several light samples are drawn, and a sample to trace is picked by its
// unshadowed contribution. The light tree that draws them knows the position of the shading point, but neither its
// normal nor its BSDF.
//
// The samples x_i, i < n, have density p; g is the unshadowed contribution times the MIS weight w. Sample i is picked
// in proportion to g_i / p_i and contributes (f L V w)(x) / g(x) * sum g_i / p_i / n. Visibility and the sum remain as
// sources of noise. Source: Talbot, Cline and Egbert 2005, Importance Resampling for Global Illumination, EGSR.
// The radiance in g is an estimate for textured lamps and skies (LightSample::uneven).
// w is the power heuristic (Veach 1997, 9.2.4) with the density n p for n candidates. Any w is unbiased as long as
// BSDF sampling uses the same.
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "transport/walk/direct_light.h"

namespace dg {

/// Number of candidate light samples at a vertex: 1 in scenes with few lights, and fewer at vertices that the camera
/// sees neither directly nor through specular bounces. CPU time x error of bench/first_picture.py is the same from four
/// to eight.
inline int light_candidates(const LightSet& lights, bool in_view) {
    constexpr std::size_t kFew = 4;
    if (lights.empty()) return 0;
    return lights.choices() <= kFew ? 1 : in_view ? int(LightSet::kMostSamples) : 2;
}

class LightPick {
  public:
    struct Random {
        float select;   // the lights
        Vec2f place;    // the points on them
        float pick;     // the candidate
    };
    /// Picks a sample among `candidates` candidates. `mis`: BSDF sampling can find the same light. `evaluate` returns
    /// the BSDF toward a light; `throughput` weighs its wavelengths.
    template <typename Evaluate>
    static std::optional<DirectLight> pick(const Scene& scene, const SurfaceHit& hit, const Wavelengths& wavelengths,
                                           int candidates, bool mis, const Random& u, Spectrum throughput,
                                           const Evaluate& evaluate);

  private:
    static constexpr std::size_t kMost = LightSet::kMostSamples;
    std::array<LightSample, kMost> lights_;
    std::array<Evaluation, kMost> f_;
    std::array<float, kMost> worth_, weight_;   // g / p and w / p
};

template <typename Evaluate>
std::optional<DirectLight> LightPick::pick(const Scene& scene, const SurfaceHit& hit,
                                           const Wavelengths& wavelengths, int candidates, bool mis, const Random& u,
                                           Spectrum throughput, const Evaluate& evaluate) {
    LightPick all;
    scene.lights().sample_several(u.select, u.place, hit.position, hit.time, wavelengths,
                                  std::span(all.lights_).first(std::size_t(candidates)));
    float sum = 0;
    for (int i = 0; i < candidates; ++i) {
        const LightSample& light = all.lights_[i];
        all.worth_[i] = 0;
        if (!(light.pdf > 0)) continue;
        const Evaluation& e = all.f_[i] = evaluate(light.wi);
        const bool light_only = light.delta || !mis;
        all.weight_[i] = (light_only ? 1 : power_heuristic(float(candidates) * light.pdf, e.pdf)) / light.pdf;
        all.worth_[i] = (throughput * e.f_cos * light.radiance).average() * all.weight_[i];
        sum += all.worth_[i];
    }
    if (!(sum > 0) || !std::isfinite(sum)) return std::nullopt;
    float rest = u.pick * sum;
    int chosen = -1;
    for (int i = 0; i < candidates && (chosen < 0 || rest >= 0); ++i)
        if (all.worth_[i] > 0) chosen = i, rest -= all.worth_[i];
    const float share = sum / (float(candidates) * all.worth_[chosen]);
    return DirectLight{all.lights_[chosen], all.f_[chosen], all.weight_[chosen] * share};
}

}  // namespace dg
