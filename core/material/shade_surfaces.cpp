// shade_surfaces.cpp -- evaluates factors times textures at a hit, and chooses the simplest sufficient BSDF.
#include "material/shade_surfaces.h"

#include "material/gltf_surface.h"

namespace dg {
namespace {

Rgb vertex_color(const SurfaceHit& hit) { return {hit.color[0], hit.color[1], hit.color[2]}; }

Rgb times_texture(Rgb factor, const TextureSlot& slot, const Textures& textures, const SurfaceHit& hit) {
    return slot.used() ? factor * rgb(read(slot, textures, hit)) : factor;
}

/// A colour or a spectrum times an RGB factor, at most 1.
Spectrum share(const SpectralColor& c, Rgb factor, const Wavelengths& wavelengths) {
    if (!c.sampled) return wavelengths.reflectance(clamped(c.rgb * factor));
    const Spectrum measured = c.sampled->at(wavelengths.nm);
    return factor == Rgb{1, 1, 1} ? measured : measured * wavelengths.reflectance(clamped(factor));
}
Spectrum share(const SpectralColor& c, const Wavelengths& wavelengths) { return share(c, {1, 1, 1}, wavelengths); }

Spectrum reflectance_of(const DiffuseMaterial& m, const Textures& textures, const SurfaceHit& hit,
                        const Wavelengths& wavelengths) {
    return share(m.reflectance, times_texture(vertex_color(hit), m.reflectance_texture, textures, hit), wavelengths);
}

bool is_white(const SpectralColor& c) { return !c.sampled && c.rgb == Rgb{1, 1, 1}; }

/// The direction of u, perpendicular to the mapped normal; the tangent belongs to the normal of the mesh.
Vec3f tangent_across(const SurfaceHit& hit) {
    const Vec3f t = hit.tangent - hit.ns * dot(hit.tangent, hit.ns);
    const float l2 = length_squared(t);
    return l2 > 1e-8f ? t / std::sqrt(l2) : Frame::from_normal(hit.ns).x;
}

struct Alphas {
    float u, v;
};
/// `clear`: for glass, with unfiltered lookups (material_read.h).
Alphas read_alphas(const Roughness& a, bool clear, const Textures& textures, const SurfaceHit& hit) {
    if (!a.texture.used()) return {a.u, a.v};
    const Texture::Texel t = clear ? read_point(a.texture, textures, hit) : read(a.texture, textures, hit);
    return {clamped(a.u * t.r), clamped(a.v * t.g)};
}

Facets read_facets(const Roughness& a, bool clear, const Textures& textures, const SurfaceHit& hit) {
    const Alphas alphas = read_alphas(a, clear, textures, hit);
    return {hit.ns, tangent_across(hit), alphas.u, alphas.v, a.distribution};
}

/// `outside`: index above the metal.
MetalReflectance metal_of(const ConductorMaterial& m, float outside, const Textures& textures, const SurfaceHit& hit,
                          const Wavelengths& wavelengths) {
    const Rgb factor = times_texture({1, 1, 1}, m.reflectance_texture, textures, hit);
    MetalReflectance r{share(m.reflectance, factor, wavelengths)};
    if (!m.fresnel) return r;
    r.fresnel = true;
    r.eta = m.eta.at(wavelengths) / outside;
    r.k = m.k.at(wavelengths) / outside;
    return r;
}

struct Index {
    float hero = 1;
    bool disperses = false;
    Spectrum each{1.f};
    Index relative_to_outside(const SurfaceHit& hit) const {
        if (hit.outside_ior == 1) return *this;
        return {hero / hit.outside_ior, disperses || hit.outside_disperses, each * (1 / hit.outside_ior)};
    }
};
Index index_of(const DielectricMaterial& m, const Wavelengths& wavelengths) {
    if (!m.ior_by_wavelength && m.dispersion <= 0) return {m.ior, false, m.ior};
    const Spectrum each = m.ior_by_wavelength ? m.ior_by_wavelength->at(wavelengths.nm)
                                              : dispersed_ior(m.ior, m.dispersion, wavelengths.nm);
    return {each[0], !wavelengths.secondary_ended, each};
}

}  // namespace

Bsdf shade_kind(const DiffuseMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    const Spectrum r = reflectance_of(m, textures, hit, wavelengths);
    if (m.transmittance.is_black()) return DiffuseBsdf{hit.ns, hit.ng, r};
    const Spectrum t =
        share(m.transmittance, times_texture({1, 1, 1}, m.transmittance_texture, textures, hit), wavelengths);
    const Spectrum sum = r + t;
    Spectrum scale(1.f);
    for (int k = 0; k < kWavelengths; ++k)
        if (sum[k] > 1) scale.set(k, 1 / sum[k]);
    return TranslucentBsdf{hit.ns, hit.ng, r * scale, t * scale};
}

Bsdf shade_kind(const ConductorMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    const MetalReflectance r = metal_of(m, 1, textures, hit, wavelengths);
    const Alphas a = read_alphas(m.alpha, false, textures, hit);
    const bool ggx = m.alpha.distribution == Distribution::ggx;
    if (!m.fresnel && a.u == a.v && ggx) return ConductorBsdf{hit.ns, hit.ng, r.factor, a.u};
    return MetalBsdf{hit.ns, hit.ng, r, {hit.ns, tangent_across(hit), a.u, a.v, m.alpha.distribution}};
}

Bsdf shade_kind(const DielectricMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    const Spectrum tint = share(m.tint, wavelengths);
    const Index n = index_of(m, wavelengths).relative_to_outside(hit);
    const Alphas a = read_alphas(m.alpha, true, textures, hit);
    const bool ggx = m.alpha.distribution == Distribution::ggx;
    if (!m.thin && !m.energy_compensation && a.u == a.v && is_white(m.reflection_tint) && ggx)
        return DielectricBsdf{hit.ns, hit.ng, tint, n.hero, a.u, n.disperses, n.each};
    GlassBsdf glass;
    glass.ns = hit.ns, glass.ng = hit.ng;
    glass.reflection_tint = share(m.reflection_tint, wavelengths), glass.tint = tint;
    glass.ior = n.hero;
    glass.thin = m.thin;
    glass.disperses = n.disperses && !m.thin;
    glass.iors = n.each;
    glass.facets = {hit.ns, tangent_across(hit), a.u, a.v, m.alpha.distribution};
    if (m.energy_compensation && !glass.is_specular())
        glass.compensation.emplace(std::max(n.hero, 1 / n.hero), glass.facets);
    return glass;
}

Bsdf shade_kind(const CoatedMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    ClearCoat coat{m.ior, read_facets(m.alpha, false, textures, hit), share(m.specular_tint, wavelengths)};
    if (m.thickness > 0) coat.depth = m.absorption.at(wavelengths) * m.thickness;
    coat.linear = !m.nonlinear;
    coat.compensated = m.energy_compensation;
    CoatedBase base;
    base.metal = m.metal;
    if (m.metal) {
        base.reflectance = metal_of(m.conductor, m.ior, textures, hit, wavelengths);
        base.facets = read_facets(m.conductor.alpha, false, textures, hit);
    } else {
        base.diffuse = reflectance_of(m.diffuse, textures, hit, wavelengths);
    }
    return Bsdf(std::in_place_type<CoatedBsdf>, hit.ns, hit.ng, coat, base);
}

SolidOptics solid_optics(const Material& material, const Wavelengths& wavelengths) {
    if (const auto* m = std::get_if<DielectricMaterial>(&material.kind)) {
        const Index index = index_of(*m, wavelengths);
        return {index.hero, index.disperses, {}};
    }
    if (const auto* m = std::get_if<GltfMaterial>(&material.kind)) return solid_optics_of(*m, wavelengths);
    if (const auto* mix = std::get_if<MixMaterial>(&material.kind))
        for (const MixPart& part : mix->parts)
            if (bounds_solid(part.most())) return solid_optics(part.most(), wavelengths);
    return {};
}

Rgb albedo_of(const DiffuseMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    const Rgb r = times_texture(m.reflectance.color() * vertex_color(hit), m.reflectance_texture, textures, hit);
    if (m.transmittance.is_black()) return clamped(r);
    return clamped(r + times_texture(m.transmittance.color(), m.transmittance_texture, textures, hit));
}

namespace {

/// Wavelengths of red, green and blue, near the centers of the primaries.
constexpr float kPrimaries[3] = {610, 550, 465};

Rgb at_primaries(const SpectralColor& c) {
    if (!c.sampled) return c.rgb;
    return {c.sampled->at(kPrimaries[0]), c.sampled->at(kPrimaries[1]), c.sampled->at(kPrimaries[2])};
}

Rgb metal_albedo(const ConductorMaterial& m, float outside, const Textures& textures, const SurfaceHit& hit) {
    const Rgb factor = clamped(times_texture(m.reflectance.color(), m.reflectance_texture, textures, hit));
    if (!m.fresnel) return factor;
    const Rgb eta = at_primaries(m.eta) / outside, k = at_primaries(m.k) / outside;
    const Spectrum r = fresnel_conductor(1, {eta.x, eta.y, eta.z, 1}, {k.x, k.y, k.z, 1});
    return factor * Rgb{r[0], r[1], r[2]};
}

}  // namespace

Rgb albedo_of(const ConductorMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    return metal_albedo(m, 1, textures, hit);
}

Rgb albedo_of(const DielectricMaterial& m, const Textures&, const SurfaceHit&) { return m.tint.color(); }

Rgb albedo_of(const CoatedMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    const float n2 = m.ior * m.ior, mean = 1 - mean_fresnel(m.ior), k = 1 - mean / n2;
    const float above = fresnel_dielectric(std::abs(dot(hit.ns, hit.wo)), m.ior);
    Rgb below;
    if (m.metal) {
        below = metal_albedo(m.conductor, m.ior, textures, hit) * (1 - above);
    } else {
        const Rgb p = albedo_of(m.diffuse, textures, hit);
        for (int i = 0; i < 3; ++i) below[i] = p[i] * mean / (n2 * (1 - (m.nonlinear ? p[i] : 1) * k));
    }
    return clamped(m.specular_tint.color() * above + below * (1 - above));
}

}  // namespace dg
