// material.cpp -- from a material and a hit to a BSDF, an emission, an opacity.
#include "material/material.h"

#include "material/gltf_surface.h"
#include "material/material_read.h"

namespace dg {

Vec3f mapped_normal(const TextureSlot& slot, float scale, const Textures& textures,
                    const SurfaceHit& hit) {
    const Texture::Texel t = read(slot, textures, hit);
    const Vec3f bitangent = cross(hit.ns, hit.tangent) * hit.tangent_sign;
    const Vec3f n = hit.tangent * ((2 * t.r - 1) * scale) +
                    bitangent * ((2 * t.g - 1) * scale) + hit.ns * (2 * t.b - 1);
    const float l2 = length_squared(n);
    return l2 > 1e-12f ? n / std::sqrt(l2) : hit.ns;
}

Vec3f visible_normal(Vec3f ns, Vec3f ng, Vec3f wo) {
    const float g = dot(ng, wo), height = std::abs(g);
    const auto good = [&](Vec3f n) {
        const float c = std::copysign(1.f, g) * dot(n, wo);
        return c >= 0.1f * height && 2 * c * dot(n, ng) - height >= 0.1f * height;
    };
    if (good(ns)) return ns;
    Vec3f best = ng;
    float low = 0, high = 1;
    for (int i = 0; i < 6; ++i) {
        const float t = 0.5f * (low + high);
        const Vec3f n = normalize(ns * (1 - t) + ng * t);
        if (good(n)) {
            high = t;
            best = n;
        } else {
            low = t;
        }
    }
    return best;
}

namespace {

Bsdf shade_kind(const DiffuseMaterial& m, const Textures&, SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    const Rgb c = m.reflectance * Rgb{hit.color[0], hit.color[1], hit.color[2]};
    return DiffuseBsdf{hit.ns, hit.ng, wavelengths.reflectance(clamped(c))};
}

Bsdf shade_kind(const ConductorMaterial& m, const Textures&, SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    return ConductorBsdf{hit.ns, hit.ng, wavelengths.reflectance(clamped(m.reflectance)),
                         m.alpha};
}

Bsdf shade_kind(const DielectricMaterial& m, const Textures&, SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    DielectricBsdf b{hit.ns, hit.ng, wavelengths.reflectance(clamped(m.tint)), m.ior,
                     m.alpha};
    if (m.dispersion <= 0) return b;
    b.iors = dispersed_ior(m.ior, m.dispersion, wavelengths.nm);
    b.ior = b.iors[0];
    b.disperses = !wavelengths.secondary_ended;
    return b;
}

/// The coat follows the mesh and not the normal map of the base, so it is read first.
Bsdf shade_kind(const GltfMaterial& m, const Textures& textures, SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    if (m.unlit) return DiffuseBsdf{hit.ns, hit.ng, 0.f};
    Coat coat;
    if (m.clearcoat.used()) coat = read_coat(m.clearcoat, textures, hit);
    if (m.normal_texture.used()) {
        hit.slope_variance = slope_variance(m, textures, hit);
        hit.ns = mapped_normal(m.normal_texture, m.normal_scale, textures, hit);
    }
    hit.ns = visible_normal(hit.ns, hit.ng, hit.wo);
    GltfSurface s = gltf_surface(m, textures, hit, wavelengths);
    if (m.anisotropy.used()) read_anisotropy(m.anisotropy, textures, hit, s);
    if (m.iridescence.used()) {
        const float outside = 1 + coat.factor * (kCoatIor - 1);
        read_iridescence(m.iridescence, textures, hit, outside, wavelengths.nm, s);
    }
    if (!m.clearcoat.used() && !m.sheen.used())
        return Bsdf(std::in_place_type<GltfBsdf>, s, hit.ns, hit.ng);
    Sheen sheen;
    if (m.sheen.used()) {
        const Rgb color = sheen_color(m.sheen, textures, hit);
        sheen = Sheen(wavelengths.reflectance(color), max_component(color),
                      sheen_roughness(m.sheen, textures, hit));
    }
    return Bsdf(std::in_place_type<LayeredBsdf>, s, hit.ns, hit.ng, coat, sheen);
}

float masked(const GltfMaterial& m, float alpha) {
    switch (m.alpha_mode) {
        case GltfMaterial::AlphaMode::opaque:
            return 1;
        case GltfMaterial::AlphaMode::mask:
            return alpha >= m.alpha_cutoff ? 1.f : 0.f;
        default:
            return clamped({alpha, 0, 0}).x;
    }
}

}  // namespace

Bsdf shade(const Material& material, const Textures& textures, SurfaceHit& hit,
           const Wavelengths& wavelengths) {
    if (!std::holds_alternative<GltfMaterial>(material.kind))
        hit.ns = visible_normal(hit.ns, hit.ng, hit.wo);
    return std::visit(
        [&](const auto& m) { return shade_kind(m, textures, hit, wavelengths); },
        material.kind);
}

namespace {

Rgb emitted_below_coat(const Material& material, const Textures& textures,
                       const SurfaceHit& hit) {
    Rgb sum{0, 0, 0};
    if (hit.front || material.two_sided_emission) sum = material.emission;
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (m && m->unlit) return sum + base_color(*m, textures, hit);
    if (!m || !(hit.front || m->double_sided) || m->emissive == Rgb{0, 0, 0}) return sum;
    if (!m->emissive_texture.used()) return sum + m->emissive;
    return sum + m->emissive * rgb(read(m->emissive_texture, textures, hit));
}

}  // namespace

bool emission_is_coated(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m && m->clearcoat.used() && emits(material);
}

Rgb emitted(const Material& material, const Textures& textures, const SurfaceHit& hit) {
    const Rgb sum = emitted_below_coat(material, textures, hit);
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (!m || !m->clearcoat.used() || max_component(sum) <= 0) return sum;
    const float cos_o = dot(coat_normal(m->clearcoat, textures, hit), hit.wo);
    return sum * (1 - coat_share(coat_factor(m->clearcoat, textures, hit), cos_o));
}

Rgb emission_factor(const GltfMaterial& m) {
    return m.unlit ? m.base_color : m.emissive;
}
const TextureSlot& emission_texture(const GltfMaterial& m) {
    return m.unlit ? m.base_color_texture : m.emissive_texture;
}

bool emits(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    const Rgb none{0, 0, 0};
    return material.emission != none || (m && emission_factor(*m) != none);
}

float opacity(const Material& material, const Textures& textures, const Vec2f uv[2],
              float vertex_alpha) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (!m || m->alpha_mode == GltfMaterial::AlphaMode::opaque) return 1;
    const float alpha = m->base_alpha * vertex_alpha;
    if (!m->base_color_texture.used()) return masked(*m, alpha);
    // At a point: the mean of what passes or not is the coverage, which a mean that is then
    // held against the cutoff would lose.
    const TextureSlot& slot = m->base_color_texture;
    const Vec2f at = slot.transform(uv[slot.uv_set]);
    return masked(*m, alpha * textures[slot.index].lookup(at).a);
}

Clear clearness(const Material& material) {
    if (const auto* d = std::get_if<DielectricMaterial>(&material.kind)) {
        if (!DielectricBsdf{{}, {}, 1.f, d->ior, d->alpha}.is_specular())
            return Clear::no;
        return d->ior == 1 ? Clear::sheet : Clear::volume;
    }
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (!m || m->transmission <= 0) return Clear::no;
    const bool textured = m->metallic_roughness_texture.used();
    const bool rough = m->roughness * m->roughness >= kSmoothAlpha;
    if (!textured && (rough || m->metallic >= 1)) return Clear::no;
    return m->thickness > 0 ? Clear::volume : Clear::sheet;
}

bool has_normal_map(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m && (m->normal_texture.used() || m->clearcoat.normal_texture.used());
}

bool has_cutout(const Material& material, const Textures&) {
    // A mesh may bring its own alpha at the vertices, so factor and texture alone prove
    // nothing.
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m && m->alpha_mode != GltfMaterial::AlphaMode::opaque;
}

namespace {

/// Sheen and coat over the albedo of the base, as seen from wo.
Rgb layered_albedo(const GltfMaterial& m, const Textures& textures, const SurfaceHit& hit,
                   Rgb base) {
    const float cos_o = dot(hit.ns, hit.wo);
    if (m.sheen.used()) {
        const Rgb color = sheen_color(m.sheen, textures, hit);
        const float roughness = sheen_roughness(m.sheen, textures, hit);
        const float e = Sheen(0.f, 1, roughness).albedo(cos_o);
        base = color * e + base * (1 - max_component(color) * e);
    }
    if (!m.clearcoat.used()) return base;
    const float c = coat_share(coat_factor(m.clearcoat, textures, hit), cos_o);
    return base * (1 - c) + Rgb{c, c, c};
}

}  // namespace

Rgb albedo(const Material& material, const Textures& textures, const SurfaceHit& hit) {
    if (const auto* m = std::get_if<DiffuseMaterial>(&material.kind))
        return clamped(m->reflectance * Rgb{hit.color[0], hit.color[1], hit.color[2]});
    if (const auto* m = std::get_if<ConductorMaterial>(&material.kind))
        return m->reflectance;
    if (const auto* m = std::get_if<DielectricMaterial>(&material.kind)) return m->tint;
    const auto& m = std::get<GltfMaterial>(material.kind);
    if (m.unlit) return base_color(m, textures, hit);
    return clamped(layered_albedo(m, textures, hit, surface_albedo(m, textures, hit)));
}

}  // namespace dg
