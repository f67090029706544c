// bsdf_diffuse.h -- two-sided Lambertian reflection.
#pragma once
#include <optional>

#include "material/bsdf_sample.h"
#include "material/ggx.h"

namespace dg {

struct DiffuseBsdf {
    Vec3f ns, ng;
    Spectrum reflectance;

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        const Facing side(ns, ng, wo);
        const float cos_i = dot(side.ns, wi);
        if (side.cos_o <= 0 || cos_i <= 0 || !side.reflects(wi)) return {};
        return {reflectance * (cos_i / kPi), cos_i / kPi};
    }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const {
        return evaluate_with_pdf(wo, wi).f_cos;
    }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }

    std::optional<BsdfSample> sample(Vec3f wo, float /*u_lobe*/, Vec2f u) const {
        const Facing side(ns, ng, wo);
        const Vec3f wi = sample_cosine(side.ns, u);
        const float cos_i = dot(side.ns, wi);
        if (side.cos_o <= 0 || cos_i <= 0 || !side.reflects(wi)) return std::nullopt;
        return BsdfSample{.wi = wi, .weight = reflectance, .pdf = cos_i / kPi};
    }
    static constexpr bool kOneLobe = true;   // sample() ignores u_lobe
    bool is_specular() const { return false; }
    Interior interior() const { return {}; }
    bool bounds_volume() const { return false; }
    Spectrum straight_transmittance(Vec3f) const { return 0.f; }
    float reversed(Vec3f, Vec3f) const { return 1; }
    float diffuse_share(Vec3f, Vec3f) const { return 1; }
};

}  // namespace dg
