// bsdf_conductor.h -- a two-sided GGX metal of constant reflectance.
#pragma once
#include <optional>

#include "material/bsdf_sample.h"
#include "material/ggx.h"

namespace dg {

struct ConductorBsdf {
    Vec3f ns, ng;
    Spectrum reflectance;
    float alpha = 0;

    static constexpr bool kOneLobe = true;   // sample() ignores u_lobe
    bool is_specular() const { return alpha < kSmoothAlpha; }
    float diffuse_share(Vec3f, Vec3f) const { return 0; }

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        const Facing side(ns, ng, wo);
        const float cos_i = dot(side.ns, wi);
        if (is_specular() || side.cos_o <= 0 || cos_i <= 0 || !side.reflects(wi))
            return {};
        const RoundGgx ggx{alpha * alpha};
        const Facet f = reflecting_facet(side.ns, wo, wi, side.cos_o, cos_i, ggx);
        return {reflectance * f.f_cos, f.pdf};
    }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const {
        return evaluate_with_pdf(wo, wi).f_cos;
    }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }

    std::optional<BsdfSample> sample(Vec3f wo, float /*u_lobe*/, Vec2f u) const {
        const Facing side(ns, ng, wo);
        if (side.cos_o <= 0) return std::nullopt;
        if (is_specular()) {
            const Vec3f wi = reflect(wo, side.ns);
            if (!side.reflects(wi)) return std::nullopt;
            return BsdfSample{
                .wi = wi, .weight = reflectance, .pdf = 1, .specular = true};
        }
        const Vec3f wi = reflect(wo, sample_visible_normal(side.ns, wo, alpha, u));
        const Evaluation e = evaluate_with_pdf(wo, wi);
        if (!(e.pdf > 0)) return std::nullopt;
        return BsdfSample{.wi = wi, .weight = e.f_cos / e.pdf, .pdf = e.pdf};
    }
    Interior interior() const { return {}; }
    bool bounds_volume() const { return false; }
    Spectrum straight_transmittance(Vec3f) const { return 0.f; }
    float reversed(Vec3f, Vec3f) const { return 1; }
};

}  // namespace dg
