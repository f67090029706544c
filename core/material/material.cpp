// material.cpp -- BSDF, emission and opacity of a material at a hit.
#include "material/material.h"

#include "material/gltf_surface.h"
#include "material/material_keys.h"
#include "material/material_read.h"
#include "material/shade_surfaces.h"
#include "math/below_one.h"

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

Vec3f facing_normal(Vec3f ns, Vec3f ng, Vec3f wo) {
    const float side = std::copysign(1.f, dot(ng, wo));
    if (side * dot(ns, wo) > 0) return ns;
    const Vec3f turned = ng * (2 * dot(ns, ng)) - ns;
    return side * dot(turned, wo) > 0 ? turned : ng;
}

namespace {

/// Share of the second part of a mixture in its opacity: rays that pass one part may be stopped by the other.
float share_of_second(const MixMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    float share = m.amount;
    if (m.amount_texture.used()) share *= clamped(read_point(m.amount_texture, textures, hit).r);
    const auto there = [&](const MixPart& part) {
        const MaterialAt now = part_at(part, hit.time);
        return opacity(now, textures, hit.uv, hit.color[3], hit.time);
    };
    if (!has_cutout(m.parts[0].most(), textures) && !has_cutout(m.parts[1].most(), textures)) return share;
    const float first = (1 - share) * there(m.parts[0]), second = share * there(m.parts[1]);
    return first + second > 0 ? second / (first + second) : share;
}

/// Calls a function with the part that the hit has chosen; the rescaled random number chooses in nested mixtures.
template <typename What>
auto in_part(const MixMaterial& m, const Textures& textures, SurfaceHit& hit, What what) {
    const float share = share_of_second(m, textures, hit), choice = hit.choice;
    const bool second = choice < share;
    hit.choice = std::min(kBelowOne, second ? choice / share : (choice - share) / (1 - share));
    const MaterialAt part = part_at(m.parts[second], hit.time);
    auto result = what(part);
    hit.choice = choice;
    return result;
}

Bsdf shade_kind(const MixMaterial& m, const Textures& textures, SurfaceHit& hit,
                const Wavelengths& wavelengths) {
    return in_part(m, textures, hit,
                   [&](const Material& part) { return shade(part, textures, hit, wavelengths); });
}

/// A BSDF that passes light unchanged.
Bsdf shade_kind(const BoundaryMaterial&, const Textures&, const SurfaceHit& hit, const Wavelengths&) {
    return DielectricBsdf{hit.ns, hit.ng, 1.f, 1, 0};
}

/// The coat uses the normal of the mesh rather than the base's normal map, so it is read first.
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
    if (!material.two_sided && !hit.front) return DiffuseBsdf{hit.ns, hit.ng, 0.f};
    if (material.normal_texture.used())
        hit.ns = mapped_normal(material.normal_texture, material.normal_scale, textures, hit);
    const bool own_normal = std::holds_alternative<GltfMaterial>(material.kind) ||
                            std::holds_alternative<MixMaterial>(material.kind);
    const bool matte = material.normal_texture.used() && std::holds_alternative<DiffuseMaterial>(material.kind);
    if (!own_normal) hit.ns = (matte ? facing_normal : visible_normal)(hit.ns, hit.ng, hit.wo);
    return std::visit(
        [&](const auto& m) { return shade_kind(m, textures, hit, wavelengths); },
        material.kind);
}

namespace {

Rgb emitted_below_coat(const Material& material, const Textures& textures,
                       const SurfaceHit& hit) {
    Rgb sum{0, 0, 0};
    if (hit.front || material.two_sided_emission) sum = material.emission;
    if (material.emission_texture.used()) sum = sum * rgb(read(material.emission_texture, textures, hit));
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

namespace {

Rgb factor_of(const GltfMaterial& m) { return m.unlit ? m.base_color : m.emissive; }

}  // namespace

Rgb emission_factor(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m ? material.emission + factor_of(*m) : material.emission;
}

std::array<TextureSlot, 2> emission_textures(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (!m) return {material.emission_texture, {}};
    return {material.emission_texture, m->unlit ? m->base_color_texture : m->emissive_texture};
}

bool emits_from_behind(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return material.two_sided_emission || (m && (m->double_sided || m->unlit));
}

bool emits(const Material& material) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    const Rgb none{0, 0, 0};
    return material.emission != none || (m && factor_of(*m) != none);
}

namespace {

float opacity_of_kind(const GltfMaterial& m, const Textures& textures, const Vec2f uv[2], float vertex_alpha) {
    if (m.alpha_mode == GltfMaterial::AlphaMode::opaque) return 1;
    const float alpha = m.base_alpha * vertex_alpha;
    if (!m.base_color_texture.used()) return masked(m, alpha);
    // Looked up at a point: the mean of thresholded values is the coverage, unlike a thresholded mean.
    const TextureSlot& slot = m.base_color_texture;
    const Vec2f at = slot.transform(uv[slot.uv_set]);
    return masked(m, alpha * textures[slot.index].lookup(at).a);
}

float opacity_of_parts(const MixMaterial& m, const Textures& textures, const Vec2f uv[2], float vertex_alpha,
                       float time) {
    float share = m.amount;
    const TextureSlot& slot = m.amount_texture;
    if (slot.used()) share *= clamped(textures[slot.index].lookup(slot.transform(uv[slot.uv_set])).r);
    const auto of = [&](const MixPart& part) {
        const MaterialAt now = part_at(part, time);
        return opacity(now, textures, uv, vertex_alpha, time);
    };
    return (1 - share) * of(m.parts[0]) + share * of(m.parts[1]);
}

}  // namespace

float opacity(const Material& material, const Textures& textures, const Vec2f uv[2],
              float vertex_alpha, float time) {
    float left = material.opacity;
    const TextureSlot& slot = material.opacity_texture;
    if (slot.used()) left *= clamped(textures[slot.index].lookup(slot.transform(uv[slot.uv_set])).r);
    if (const auto* m = std::get_if<GltfMaterial>(&material.kind))
        return left * opacity_of_kind(*m, textures, uv, vertex_alpha);
    if (const auto* m = std::get_if<MixMaterial>(&material.kind))
        return left * opacity_of_parts(*m, textures, uv, vertex_alpha, time);
    return left;
}

namespace {

Clear clearness_of(const DiffuseMaterial&) { return Clear::no; }
Clear clearness_of(const ConductorMaterial&) { return Clear::no; }
Clear clearness_of(const CoatedMaterial&) { return Clear::no; }
Clear clearness_of(const BoundaryMaterial&) { return Clear::sheet; }

Clear clearness_of(const DielectricMaterial& m) {
    if (m.thin) return m.alpha.may_be_smooth() ? Clear::sheet : Clear::no;
    const bool bends_nothing = std::abs(m.ior - 1) < 1e-3f || m.ior_by_wavelength;   // at some wavelength
    if (!m.alpha.may_be_smooth() && !bends_nothing) return Clear::no;
    return m.ior == 1 && !m.ior_by_wavelength ? Clear::sheet : Clear::volume;
}

Clear clearness_of(const GltfMaterial& m) {
    if (m.transmission <= 0) return Clear::no;
    const bool textured = m.metallic_roughness_texture.used();
    const bool rough = m.roughness * m.roughness >= kSmoothAlpha;
    if (!textured && (rough || m.metallic >= 1)) return Clear::no;
    return m.thickness > 0 ? Clear::volume : Clear::sheet;
}

/// A sheet among the parts of a mixture requires a test for every shadow ray; volumes block the rays that they must.
Clear clearness_of(const MixMaterial& m) {
    Clear clearest = Clear::no;
    for (const MixPart& part : m.parts) {
        const Clear c = part.change ? clearness(part.change->range) : clearness(*part.still);
        if (c == Clear::sheet || clearest == Clear::no) clearest = c;
    }
    return clearest;
}

template <typename Check>
bool any_part(const Material& material, Check check) {
    const auto* mix = std::get_if<MixMaterial>(&material.kind);
    return mix && (check(mix->parts[0].most()) || check(mix->parts[1].most()));
}

}  // namespace

Clear clearness(const Material& material) {
    return std::visit([](const auto& m) { return clearness_of(m); }, material.kind);
}

bool has_normal_map(const Material& material) {
    if (material.normal_texture.used() || any_part(material, has_normal_map)) return true;
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m && (m->normal_texture.used() || m->clearcoat.normal_texture.used());
}

bool bounds_solid(const Material& material) {
    if (any_part(material, bounds_solid)) return true;
    if (const auto* m = std::get_if<DielectricMaterial>(&material.kind)) return !m->thin;
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m && m->transmission > 0 && m->thickness > 0;
}

bool is_one_sided(const Material& material) {
    return !material.two_sided || any_part(material, is_one_sided);
}

bool has_cutout(const Material& material, const Textures& textures) {
    if (material.opacity < 1 || material.opacity_texture.used()) return true;
    if (any_part(material, [&](const Material& part) { return has_cutout(part, textures); })) return true;
    // Vertex colours may have alpha, so factor and texture do not suffice.
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    return m && m->alpha_mode != GltfMaterial::AlphaMode::opaque;
}

namespace {

/// Albedo of the base with sheen and coat, from wo.
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

namespace {

Rgb albedo_of(const BoundaryMaterial&, const Textures&, const SurfaceHit&) { return {1, 1, 1}; }

Rgb albedo_of(const MixMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    SurfaceHit here = hit;
    return in_part(m, textures, here, [&](const Material& part) { return albedo(part, textures, here); });
}

Rgb albedo_of(const GltfMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    if (m.unlit) return base_color(m, textures, hit);
    return clamped(layered_albedo(m, textures, hit, surface_albedo(m, textures, hit)));
}

}  // namespace

Rgb albedo(const Material& material, const Textures& textures, const SurfaceHit& hit) {
    return std::visit([&](const auto& m) { return albedo_of(m, textures, hit); }, material.kind);
}

}  // namespace dg
