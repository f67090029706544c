// bsdf_metal.h -- a metal with isotropic or anisotropic facets, and Fresnel or constant reflectance.
#pragma once
#include <optional>

#include "material/facets.h"
#include "material/fresnel_conductor.h"

namespace dg {

/// Reflectance of a facet of a metal.
struct MetalReflectance {
    Spectrum factor{1.f};
    bool fresnel = false;   // Fresnel reflectance times the factor; false: the factor alone
    Spectrum eta{1.f}, k{0.f};

    Spectrum at(float cos_h) const { return fresnel ? factor * fresnel_conductor(cos_h, eta, k) : factor; }
};

struct MetalBsdf {
    Vec3f ns, ng;
    MetalReflectance reflectance;
    Facets facets;

    static constexpr bool kOneLobe = true;   // sample() ignores u_lobe
    bool is_specular() const { return facets.smooth; }
    float diffuse_share(Vec3f, Vec3f) const { return 0; }

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        const Facing side(ns, ng, wo);
        const float cos_i = dot(side.ns, wi);
        if (is_specular() || side.cos_o <= 0 || cos_i <= 0 || !side.reflects(wi)) return {};
        const Facet f = facets.reflecting(side.ns, wo, wi, side.cos_o, cos_i);
        return {reflectance.at(f.cos_h) * f.f_cos, f.pdf};
    }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).f_cos; }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }

    std::optional<BsdfSample> sample(Vec3f wo, float /*u_lobe*/, Vec2f u) const {
        const Facing side(ns, ng, wo);
        if (side.cos_o <= 0) return std::nullopt;
        if (is_specular()) {
            const Vec3f wi = reflect(wo, side.ns);
            if (!side.reflects(wi)) return std::nullopt;
            return BsdfSample{.wi = wi, .weight = reflectance.at(side.cos_o), .pdf = 1, .specular = true};
        }
        const Vec3f wi = reflect(wo, facets.sample_visible(side.ns, wo, u));
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
