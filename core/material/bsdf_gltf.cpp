// bsdf_gltf.cpp -- set-up and sampling of the glTF material.
#include "material/bsdf_gltf.h"

#include "material/baked.h"

namespace dg {
namespace {

/// Facets need a change of index to refract; this minimum is invisible.
float bending_ior(float ior) {
    return std::abs(ior - 1) < kSmoothAlpha || ior <= 0 ? 1 + kSmoothAlpha : ior;
}

Spectrum clamped(Spectrum s, float low, float high) {
    for (int i = 0; i < kWavelengths; ++i) s.set(i, std::clamp(s[i], low, high));
    return s;
}

/// E_c = E + F'^2 (1 - Ess) in the lanes of LobeAlbedo, with F' = F0 in the second term: light reflected from facet to
/// facet may enter at the second facet, so that nothing enters for F0 = 1.
Spectrum coupling_of(float f0, float f90) {
    return {f0 - f0 * f0, f90 - f0 * f90, f0 * (f90 - f0), f0 * f0};
}

/// Cosine in air of a direction with the cosine cos_h to a facet, on either side; 0 for total internal reflection.
float cos_in_air(float cos_h, float eta) {
    if (eta >= 1) return cos_h;
    return std::sqrt(std::max(0.f, 1 - (1 - cos_h * cos_h) / (eta * eta)));
}

}  // namespace

FilmFresnel::FilmFresnel(const GltfSurface& s, Spectrum f0, float opaque)
    : film(s.film),
      factor(s.iridescence),
      metal(s.metallic),
      dielectric(opaque),
      specular(s.specular),
      metal_ior(index_of_f0(s.base)),
      dielectric_ior(index_of_f0(specular > 0 ? f0 / specular : f0)) {}

Spectrum FilmFresnel::mixed(Spectrum plain, float cos_h) const {
    Spectrum f{0.f};
    if (dielectric > 0) f += on_dielectric(cos_h) * dielectric;
    if (metal > 0) f += film.reflectance(cos_h, metal_ior) * metal;
    return lerp(factor, plain, f);
}

GltfBsdf::GltfBsdf(const GltfSurface& s, Vec3f shading, Vec3f geometric)
    : ns(shading),
      ng(geometric),
      alpha(s.roughness * s.roughness),
      smooth(alpha < kSmoothAlpha) {
    row = smooth ? GgxAlbedo::smooth_row() : baked::ggx.row(s.roughness);

    f0_ior = normal_reflectance(s.ior);  // 1 for ior 0 (KHR_materials_ior)
    f0 = clamped(s.specular_color * f0_ior, 0, 1) * s.specular;
    f0_max = f0.max();
    f90 = s.specular;
    ior = bending_ior(s.ior);
    if (s.ior <= 0) f0_ior = 0;  // the exact curve below uses the index 1
    disperses = s.disperses;
    if (disperses) disperse(s);

    const float dielectric = 1 - s.metallic;
    clear_weight = dielectric * s.transmission;
    transmitted = s.base * clear_weight;
    clear = clear_weight <= 0 ? Clear::none : s.volume ? Clear::volume : Clear::thin;

    // A thin clear part reflects like the opaque part; a volume uses the exact curve.
    const float layered = clear == Clear::volume ? dielectric - clear_weight : dielectric;
    const float r90 = s.metallic + f90 * layered;
    r0 = s.base * s.metallic + f0 * layered;
    r90_r0 = Spectrum(r90) - r0;
    const float r0_mean = r0.average();
    has_specular = r0_mean > 0 || r90 > 0 || clear_weight > 0;
    specular_albedo = {r0_mean, r90, 0, transmitted.average() + 0.05f * clear_weight};

    float f0_above = f0_max;  // of the interface above the diffuse lobe
    if (s.iridescence > 0) {
        film.emplace(s, f0, layered);
        const float bound = f90 * schlick_bound(s.film, film->dielectric_ior);
        f0_above += s.iridescence * (bound - f0_max);
        specular_albedo.set(0, film->mixed(r0, 1).average());
    }
    if (s.anisotropy > 0) stretch(s);

    coupling = coupling_of(f0_above, f90);
    const float entering = 1 - weigh(row.mean, coupling);
    diffuse = s.base * (entering > 1e-4f ? dielectric - clear_weight : 0.f);
    diffuse_albedo = diffuse.average();
    if (diffuse_albedo > 0) diffuse = diffuse / entering;
    if (s.diffuse_transmission > 0 && entering > 1e-4f)
        set_through(s, dielectric - clear_weight, entering);
    bends = clear == Clear::volume || (through_share > 0 && s.volume);
    if (bends) inside = s.interior;
}

void GltfBsdf::set_through(const GltfSurface& s, float weight, float entering) {
    const Spectrum color =
        s.diffuse_transmission_color * (weight * s.diffuse_transmission);
    const float albedo = color.average();
    diffuse = diffuse * (1 - s.diffuse_transmission);
    diffuse_albedo = diffuse_albedo * (1 - s.diffuse_transmission) + albedo;
    if (albedo <= 0) return;
    through = color / entering;
    through_share = albedo / diffuse_albedo;
}

void GltfBsdf::disperse(const GltfSurface& s) {
    iors = s.iors;
    for (int k = 0; k < kWavelengths; ++k) {
        const float f = normal_reflectance(iors[k]);
        f0.set(k, std::min(s.specular_color[k] * f, 1.f) * s.specular);
    }
    f0_max = std::min(s.specular_color.max() * f0_ior, 1.f) * s.specular;
}

/// Reflectance as in split() for a volume, with a separate curve per wavelength.
Spectrum GltfBsdf::dispersed_reflectance(float cos_h, bool front) const {
    Spectrum r = fresnel_dielectric(cos_h, iors, front);
    for (int k = 0; k < kWavelengths; ++k) {
        const float f = normal_reflectance(iors[k]);
        const float shape = std::max(0.f, r[k] - f) / (1 - f);
        if (r[k] < 1) r.set(k, f0[k] + (f90 - f0[k]) * shape);
    }
    return r;
}

void GltfBsdf::stretch(const GltfSurface& s) {
    const float across = std::max(alpha, kSmoothAlpha);
    const float along = alpha + (1 - alpha) * s.anisotropy * s.anisotropy;
    stretched = StretchedGgx{s.tangent, cross(ns, s.tangent), std::max(along, across),
                             across};
    smooth = false;
    // Each direction has the albedo of isotropic facets with the same masking. The mean over azimuths is computed by
    // the midpoint rule over half a turn.
    constexpr int kTurns = 8;
    row.mean = 0.f;
    for (int i = 0; i < kTurns; ++i) {
        const Vec2f d = unit_circle((static_cast<float>(i) + 0.5f) / (2 * kTurns));
        const Vec3f w = stretched->tangent * d.x + stretched->bitangent * d.y;
        row.mean += stretched_row(w).mean / kTurns;
    }
}

GgxAlbedo::Row GltfBsdf::stretched_row(Vec3f w) const {
    return baked::ggx.row(std::sqrt(stretched->alpha_toward(w)));
}

Facet GltfBsdf::reflecting(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const {
    if (stretched)
        return reflecting_facet(side.ns, wo, wi, side.cos_o, cos_i, *stretched);
    return reflecting_facet(side.ns, wo, wi, side.cos_o, cos_i, RoundGgx{alpha * alpha});
}

Facet GltfBsdf::refracting(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const {
    const float n = eta(side.front);
    if (stretched)
        return refracting_facet(side.ns, wo, wi, side.cos_o, cos_i, *stretched, n);
    return refracting_facet(side.ns, wo, wi, side.cos_o, cos_i, RoundGgx{alpha * alpha},
                            n);
}

Vec3f GltfBsdf::sample_facet(Vec3f n, Vec3f wo, Vec2f u) const {
    if (!stretched) return sample_visible_normal(n, wo, alpha, u);
    const StretchedGgx& g = *stretched;
    return sample_visible_normal(Frame{g.tangent, g.bitangent, n}, wo,
                                 Vec2f{g.alpha_t, g.alpha_b}, u);
}

GltfBsdf::Split GltfBsdf::split(float cos_h, float eta) const {
    const float s = schlick(cos_h);
    Split p{.reflected = r0 + r90_r0 * s};
    if (film) p.reflected = film->mixed(p.reflected, cos_h);
    if (clear == Clear::none) return p;
    float f_max = f0_max + (f90 - f0_max) * s;
    Spectrum volume{0.f};
    bool total = false;
    if (clear == Clear::volume) {
        const float exact = fresnel_dielectric(cos_h, eta);
        const float shape = std::max(0.f, exact - f0_ior) / (1 - f0_ior);
        total = exact >= 1;
        f_max = total ? 1.f : f0_max + (f90 - f0_max) * shape;
        volume = disperses ? dispersed_reflectance(cos_h, eta > 1)
                 : total   ? Spectrum(1.f)
                           : lerp(shape, f0, Spectrum(f90));
    }
    Spectrum stopped(f_max);
    if (film && !total) {
        const Spectrum f = film->on_dielectric(cos_in_air(cos_h, eta));
        stopped = lerp(film->factor, stopped, f);
        if (clear == Clear::volume) volume = lerp(film->factor, volume, f);
    }
    p.reflected += volume * clear_weight;
    p.transmitted = transmitted * (1 - stopped);
    if (disperses) p.transmitted *= hero_alone();
    const float r = p.reflected.average(), t = p.transmitted.average();
    p.reflect_probability = t > 0 ? r / (r + t) : 1.f;
    return p;
}

Spectrum GltfBsdf::straight_transmittance(Vec3f wo) const {
    const Facing side(ns, ng, wo);
    if (!smooth || clear == Clear::none || side.cos_o <= 0) return 0.f;
    if (disperses) {
        Spectrum r = dispersed_reflectance(side.cos_o, true);
        if (film) r = lerp(film->factor, r, film->on_dielectric(side.cos_o));
        return transmitted * (1 - r);
    }
    return split(side.cos_o, clear == Clear::volume ? std::max(ior, 1 / ior) : 1.f)
        .transmitted;
}

GltfBsdf::Seen GltfBsdf::seen_from(Vec3f wo) const {
    Seen seen{wo, Facing(ns, ng, wo)};
    if (seen.side.cos_o <= 0 || diffuse_albedo == 0) return seen;
    seen.diffuse_probability = 1;
    if (!has_specular) return seen;
    const LobeAlbedo albedo = lobe_albedo(wo, seen.side.cos_o);
    seen.interface = weigh(albedo, coupling);
    const float d = diffuse_albedo * (1 - seen.interface);
    seen.diffuse_probability = d / (d + weigh(albedo, specular_albedo));
    return seen;
}

float GltfBsdf::albedo_estimate(Vec3f wo) const {
    const LobeAlbedo albedo = lobe_albedo(wo, std::abs(dot(ns, wo)));
    const float specular = has_specular ? weigh(albedo, specular_albedo) : 0.f;
    return specular + diffuse_albedo * (1 - weigh(albedo, coupling));
}

Evaluation GltfBsdf::evaluate_diffuse(const Seen& seen, Vec3f wi, float cos_i) const {
    if (seen.diffuse_probability == 0) return {};
    const float e_i = has_specular ? weigh(lobe_albedo(wi, cos_i), coupling) : 0.f;
    return {diffuse * ((1 - seen.interface) * (1 - e_i) * cos_i / kPi),
            seen.diffuse_probability * (1 - through_share) * cos_i / kPi};
}

/// cos_i > 0: cosine between wi and the normal on its side.
Evaluation GltfBsdf::evaluate_through(const Seen& seen, Vec3f wi, float cos_i,
                                      float eta) const {
    const float e_i = has_specular ? weigh(lobe_albedo(wi, cos_i), coupling) : 0.f;
    const float f = (1 - seen.interface) * (1 - e_i) * cos_i / (kPi * eta * eta);
    return {through * (disperses ? hero_alone() * f : Spectrum(f)),
            seen.diffuse_probability * through_share * cos_i / kPi, disperses};
}

float GltfBsdf::diffuse_share(Vec3f wo, Vec3f wi) const {
    const Seen seen = seen_from(wo);
    const float all = evaluate_with_pdf(seen, wi).f_cos.average(), cos_i = dot(seen.side.ns, wi);
    if (!(all > 0)) return 1;
    const Evaluation diffused = seen.side.reflects(wi) ? evaluate_diffuse(seen, wi, cos_i)
                                                       : evaluate_through(seen, wi, -cos_i, eta(seen.side.front));
    return std::min(1.f, diffused.f_cos.average() / all);
}

Evaluation GltfBsdf::evaluate_with_pdf(const Seen& seen, Vec3f wi) const {
    const Vec3f wo = seen.wo;
    const Facing& side = seen.side;
    if (side.cos_o <= 0) return {};
    const float cos_i = dot(side.ns, wi);
    const float specular = 1 - seen.diffuse_probability;
    if (side.reflects(wi)) {
        if (cos_i <= 0) return {};
        Evaluation e = evaluate_diffuse(seen, wi, cos_i);
        if (smooth || !has_specular) return e;
        const Facet f = reflecting(side, wo, wi, cos_i);
        const Split p = split(f.cos_h, eta(side.front));
        e.f_cos += p.reflected * f.f_cos;
        e.pdf += specular * p.reflect_probability * f.pdf;
        return e;
    }
    if (cos_i >= 0) return {};
    const float n = eta(side.front);
    const Evaluation diffused =
        through_share > 0 ? evaluate_through(seen, wi, -cos_i, n) : Evaluation{};
    if (smooth || clear == Clear::none) return diffused;
    const Vec3f mirrored = wi - side.ns * (2 * cos_i);
    const Facet f = clear == Clear::thin ? reflecting(side, wo, mirrored, -cos_i)
                                         : refracting(side, wo, wi, cos_i);
    const Split p = split(f.cos_h, n);
    return {diffused.f_cos + p.transmitted * f.f_cos,
            diffused.pdf + specular * (1 - p.reflect_probability) * f.pdf, disperses};
}

std::optional<BsdfSample> GltfBsdf::sample(const Seen& seen, float u_lobe, Vec2f u) const {
    const Vec3f wo = seen.wo;
    const Facing& side = seen.side;
    if (side.cos_o <= 0) return std::nullopt;
    BsdfSample s;
    if (u_lobe < seen.diffuse_probability) {
        s.wi = sample_cosine(side.ns, u);
        s.transmitted = u_lobe < seen.diffuse_probability * through_share;
        if (s.transmitted) {
            s.wi = -s.wi;
            s.eta = eta(side.front);
            s.hero_only = disperses;
        }
    } else {
        if (!has_specular) return std::nullopt;  // black
        const float specular = 1 - seen.diffuse_probability, n = eta(side.front);
        u_lobe = (u_lobe - seen.diffuse_probability) / specular;
        const Vec3f h = smooth ? side.ns : sample_facet(side.ns, wo, u);
        const float cos_h = dot(wo, h);
        const Split p = split(cos_h, n);
        s.transmitted = u_lobe >= p.reflect_probability;
        s.wi = reflect(wo, h);
        if (s.transmitted && clear == Clear::thin) {
            s.wi = s.wi - side.ns * (2 * dot(side.ns, s.wi));
        } else if (s.transmitted) {
            s.wi = refract(wo, h, n);
            s.eta = n;
            s.hero_only = disperses;
        }
        if (smooth) {
            const float chosen =
                s.transmitted ? 1 - p.reflect_probability : p.reflect_probability;
            if (side.reflects(s.wi) == s.transmitted) return std::nullopt;
            s.specular = true;
            s.pdf = specular * chosen;
            s.weight = (s.transmitted ? p.transmitted / (n * n) : p.reflected) / s.pdf;
            return s;
        }
    }
    if (side.reflects(s.wi) == s.transmitted) return std::nullopt;
    const Evaluation e = evaluate_with_pdf(seen, s.wi);
    if (!(e.pdf > 0)) return std::nullopt;
    s.weight = e.f_cos / e.pdf;
    s.pdf = e.pdf;
    return s;
}

}  // namespace dg
