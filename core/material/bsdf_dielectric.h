// bsdf_dielectric.h -- clear glass, smooth or GGX rough; normals point outside. Transports radiance: light that enters
// a medium of relative index eta is compressed into a smaller solid angle, so the radiance inside is higher by eta^2,
// and a path from the camera carries 1 / eta^2 (Veach 1997, 5.2). The factors of entering and leaving cancel.
#pragma once
#include <optional>

#include "material/bsdf_sample.h"
#include "material/dispersive.h"
#include "material/fresnel.h"
#include "material/ggx.h"
#include "spectrum/wavelengths.h"

namespace dg {

struct DielectricBsdf {
    Vec3f ns, ng;
    Spectrum tint{1.f};
    float ior = 1.5f;  // at the hero wavelength
    float alpha = 0;
    bool disperses = false;  // refracted light is for the hero only
    Spectrum iors{1.f};      // per wavelength, if it disperses

    /// An interface without a change of index does not scatter: it is a window.
    static constexpr bool kOneLobe = false;
    bool is_specular() const { return alpha < kSmoothAlpha || std::abs(ior - 1) < 1e-3f; }
    float diffuse_share(Vec3f, Vec3f) const { return 0; }

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        const Facing side(ns, ng, wo);
        if (is_specular() || side.cos_o <= 0) return {};
        const float cos_i = dot(side.ns, wi), eta = side.front ? ior : 1 / ior;
        const bool reflected = side.reflects(wi);
        if (reflected ? cos_i <= 0 : cos_i >= 0) return {};
        const RoundGgx ggx{alpha * alpha};
        const Facet f =
            reflected ? reflecting_facet(side.ns, wo, wi, side.cos_o, cos_i, ggx)
                      : refracting_facet(side.ns, wo, wi, side.cos_o, cos_i, ggx, eta);
        const Split p = split(f.cos_h, eta, side.front);
        if (reflected) return {p.reflectance * f.f_cos, p.probability * f.pdf};
        return {tint * (p.transmittance * f.f_cos), (1 - p.probability) * f.pdf,
                disperses};
    }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const {
        return evaluate_with_pdf(wo, wi).f_cos;
    }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }

    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const {
        const Facing side(ns, ng, wo);
        if (side.cos_o <= 0) return std::nullopt;
        const bool smooth = is_specular();
        const float eta = side.front ? ior : 1 / ior;
        const Vec3f h = smooth ? side.ns : sample_visible_normal(side.ns, wo, alpha, u);
        const Split p = split(dot(wo, h), eta, side.front);
        const bool transmitted = u_lobe >= p.probability;
        const Vec3f wi = transmitted ? refract(wo, h, eta) : reflect(wo, h);
        if (side.reflects(wi) == transmitted) return std::nullopt;
        BsdfSample s{.wi = wi, .specular = smooth, .transmitted = transmitted};
        if (transmitted) s.eta = eta;
        s.hero_only = transmitted && disperses;
        if (smooth) {
            s.pdf = transmitted ? 1 - p.probability : p.probability;
            s.weight = transmitted ? tint * (p.transmittance / (s.pdf * eta * eta))
                                   : p.reflectance / s.pdf;
            return s;
        }
        const Evaluation e = evaluate_with_pdf(wo, wi);
        if (!(e.pdf > 0)) return std::nullopt;
        s.weight = e.f_cos / e.pdf;
        s.pdf = e.pdf;
        return s;
    }
    Interior interior() const { return {}; }
    bool bounds_volume() const { return ior != 1; }
    float reversed(Vec3f, Vec3f) const { return 1; }
    Spectrum straight_transmittance(Vec3f wo) const {
        const Facing side(ns, ng, wo);
        if (!is_specular() || side.cos_o <= 0) return 0.f;
        const float r = fresnel_dielectric(side.cos_o, std::max(ior, 1 / ior));
        if (!disperses) return tint * (1 - r);
        return tint * (Spectrum(1.f) - fresnel_dielectric(side.cos_o, iors, true));
    }

  private:
    /// Fresnel split at a facet with the cosine cos_h to wo, and the probability of reflection.
    struct Split {
        Spectrum reflectance, transmittance;
        float probability;
    };
    Split split(float cos_h, float eta, bool front) const {
        const float r = fresnel_dielectric(cos_h, eta);
        if (!disperses) return {r, 1 - r, r};
        // Reflection serves all wavelengths, refraction only the hero.
        const Spectrum all = fresnel_dielectric(cos_h, iors, front);
        const float mean = all.average();
        return {all, hero_alone() * (1 - r), mean / (mean + 1 - r)};
    }
};

}  // namespace dg
