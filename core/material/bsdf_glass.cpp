// bsdf_glass.cpp -- evaluation and sampling of glass.
#include "material/bsdf_glass.h"

namespace dg {

namespace {

/// Isotropic facets that block the same share of light near the normal as anisotropic facets.
Facets rounded(Facets f) {
    f.ggx.alpha_t = f.ggx.alpha_b = std::sqrt(f.ggx.alpha_t * f.ggx.alpha_b);
    return f;
}

}  // namespace

GlassCompensation::GlassCompensation(float n, const Facets& facets) : albedo(n, rounded(facets)) {
    const float thin = albedo.mean().missing_thin, dense = albedo.mean().missing_dense, both = std::min(thin, dense);
    const float mean = mean_fresnel(n), passes = 1 - mean;
    transmitted_pane = passes / (1 + mean);
    if (!used()) return;
    transmitted_thin = passes * both / thin;
    transmitted_dense = passes / (n * n) * both / dense;
}

Spectrum GlassBsdf::reflectance(float cos_h, bool front) const {
    const Spectrum one = fresnel_dielectric(cos_h, iors, front);
    return thin ? one * 2.f / (Spectrum(1.f) + one) : one;
}

GlassBsdf::Split GlassBsdf::split(float cos_h, float eta, bool front) const {
    Split s;
    if (thin) {
        const Spectrum r = reflectance(cos_h, true);
        s = {reflection_tint * r, tint * (Spectrum(1.f) - r), 1};
    } else if (disperses) {
        const float passed = 1 - fresnel_dielectric(cos_h, eta);
        s = {reflection_tint * reflectance(cos_h, front), tint * hero_alone() * passed, 1};
    } else {
        const float r = fresnel_dielectric(cos_h, eta);
        s = {reflection_tint * r, tint * (1 - r), 1};
    }
    const float r = s.reflected.average(), t = s.transmitted.average();
    if (t > 0) s.probability = r / (r + t);
    return s;
}

Facet GlassBsdf::joined(const Facing& side, Vec3f wo, Vec3f wi, float cos_i, bool reflected) const {
    if (reflected) return facets.reflecting(side.ns, wo, wi, side.cos_o, cos_i);
    if (!thin) return facets.refracting(side.ns, wo, wi, side.cos_o, cos_i, eta(side.front));
    const Vec3f mirrored = wi - side.ns * (2 * cos_i);
    return facets.reflecting(side.ns, wo, mirrored, side.cos_o, -cos_i);
}

GlassBsdf::DiffuseCompensation GlassBsdf::diffuse_compensation(const Facing& side, Vec3f wo) const {
    if (!compensation || !compensation->used()) return {};
    const GlassCompensation& c = *compensation;
    const GlassLobes here = c.albedo.toward(wo, side.cos_o), &mean = c.albedo.mean();
    if (thin) return {1 - here.facets, c.transmitted_pane, 1 - mean.facets, 1 - mean.facets, true};
    if (side.front == (ior > 1))
        return {here.missing_thin, c.transmitted_thin, mean.missing_thin, mean.missing_dense, true};
    return {here.missing_dense, c.transmitted_dense, mean.missing_dense, mean.missing_thin, false};
}

void GlassBsdf::add_compensation(const DiffuseCompensation& e, const Facing& side, Vec3f wi, bool reflected,
                                 Evaluation& sum) const {
    sum.pdf *= 1 - e.share;
    if (e.share == 0) return;
    const float cosine = std::abs(dot(side.ns, wi));
    const GlassLobes there = compensation->albedo.toward(wi, cosine);
    const float missing = thin                        ? 1 - there.facets
                          : e.thin_side == reflected ? there.missing_thin
                                                     : there.missing_dense;
    const float n = eta(side.front), f = e.share * missing * cosine / kPi;
    const float chosen = reflected ? 1 - e.transmitted : e.transmitted;
    sum.pdf += e.share * chosen * cosine / kPi;
    if (reflected)
        sum.f_cos += reflection_tint * (chosen * f / e.mean_here);
    else
        sum.f_cos += tint * (disperses ? hero_alone() : Spectrum(1.f)) * (chosen * f / (n * n * e.mean_beyond));
}

Evaluation GlassBsdf::evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
    const Facing side(ns, ng, wo);
    if (is_specular() || side.cos_o <= 0) return {};
    const float cos_i = dot(side.ns, wi);
    const bool reflected = side.reflects(wi);
    if (reflected ? cos_i <= 0 : cos_i >= 0) return {};
    const Facet f = joined(side, wo, wi, cos_i, reflected);
    const Split p = split(f.cos_h, eta(side.front), side.front);
    Evaluation e = reflected ? Evaluation{p.reflected * f.f_cos, p.probability * f.pdf}
                             : Evaluation{p.transmitted * f.f_cos, (1 - p.probability) * f.pdf, disperses};
    if (compensation) add_compensation(diffuse_compensation(side, wo), side, wi, reflected, e);
    return e;
}

std::optional<BsdfSample> GlassBsdf::sample(Vec3f wo, float u_lobe, Vec2f u) const {
    const Facing side(ns, ng, wo);
    if (side.cos_o <= 0) return std::nullopt;
    const bool smooth = is_specular();
    const float n = eta(side.front);
    const DiffuseCompensation e = smooth ? DiffuseCompensation{} : diffuse_compensation(side, wo);
    BsdfSample s;
    s.specular = smooth;
    float probability = 1;
    Split p;
    if (u_lobe < e.share) {
        s.wi = sample_cosine(side.ns, u);
        s.transmitted = u_lobe < e.share * e.transmitted;
        if (s.transmitted) s.wi = -s.wi;
    } else {
        u_lobe = (u_lobe - e.share) / (1 - e.share);
        const Vec3f h = smooth ? side.ns : facets.sample_visible(side.ns, wo, u);
        p = split(dot(wo, h), n, side.front);
        s.transmitted = u_lobe >= p.probability;
        probability = s.transmitted ? 1 - p.probability : p.probability;
        s.wi = s.transmitted && !thin ? refract(wo, h, n) : reflect(wo, h);
        if (s.transmitted && thin) s.wi = s.wi - side.ns * (2 * dot(side.ns, s.wi));
    }
    if (side.reflects(s.wi) == s.transmitted) return std::nullopt;
    if (s.transmitted) s.eta = n;
    s.hero_only = s.transmitted && disperses;
    if (smooth) {
        s.pdf = probability;
        s.weight = (s.transmitted ? p.transmitted / (n * n) : p.reflected) / probability;
        return s;
    }
    const Evaluation found = evaluate_with_pdf(wo, s.wi);
    if (!(found.pdf > 0)) return std::nullopt;
    s.weight = found.f_cos / found.pdf;
    s.pdf = found.pdf;
    return s;
}

Spectrum GlassBsdf::straight_transmittance(Vec3f wo) const {
    const Facing side(ns, ng, wo);
    if (!is_specular() || side.cos_o <= 0) return 0.f;
    // Ignores refraction: see straight_transmittance() in bsdf_kind.h.
    return tint * (Spectrum(1.f) - reflectance(side.cos_o, thin || ior >= 1));
}

}  // namespace dg
