#include "material/gltf_surface.h"

#include "material/material_read.h"

namespace dg {
namespace {

// Deviation of 8-bit normals from unit length, doubled, as pyramids round again.
constexpr float kNormalRounding = 0.01f;

}  // namespace

/// Variance of the slopes per axis under the footprint, from the length of the mean normal. Source: Toksvig 2005,
/// Mipmapping Normal Maps, Journal of Graphics Tools.
float slope_variance(const GltfMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    const TextureSlot& slot = m.normal_texture;
    if (!(textures[slot.index].level(slot.turned(hit.footprint[slot.uv_set])) > 0)) return 0;
    const Texture::Texel t = read(slot, textures, hit);
    const float l = std::max(length(Vec3f{2 * t.r - 1, 2 * t.g - 1, 2 * t.b - 1}), 0.1f);
    return std::max(0.f, (1 - l) / l - kNormalRounding) * m.normal_scale * m.normal_scale;
}

Rgb base_color(const GltfMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    Rgb c = m.base_color * Rgb{hit.color[0], hit.color[1], hit.color[2]};
    if (m.base_color_texture.used())
        c = c * rgb(read(m.base_color_texture, textures, hit));
    return clamped(c);
}

namespace {

/// Adds unresolved bumps to the roughness: a Gaussian of slopes of variance v has alpha^2 = 2 v (Beckmann), and
/// variances add.
float roughened(float roughness, float slope_variance) {
    if (slope_variance == 0) return roughness;
    const float alpha = roughness * roughness;
    return std::sqrt(std::min(1.f, std::sqrt(alpha * alpha + 2 * slope_variance)));
}

/// Windows stay smooth: bumps do not deflect light that passes a thin sheet.
void read_metallic_roughness(const GltfMaterial& m, const Textures& textures,
                             const SurfaceHit& hit, GltfSurface& s) {
    const bool clear = m.transmission > 0;
    s.metallic = m.metallic;
    s.roughness = m.roughness;
    if (m.metallic_roughness_texture.used()) {
        const Texture::Texel t =
            clear ? read_point(m.metallic_roughness_texture, textures, hit)
                  : read(m.metallic_roughness_texture, textures, hit);
        s.metallic = clamped(m.metallic * t.b);
        s.roughness = clamped(m.roughness * t.g);
    }
    if (clear && s.roughness * s.roughness < kSmoothAlpha) return;
    s.roughness = roughened(s.roughness, hit.slope_variance);
}

Rgb read_specular(const GltfMaterial& m, const Textures& textures, const SurfaceHit& hit,
                  GltfSurface& s) {
    s.ior = m.ior;
    s.specular = m.specular;
    if (m.specular_texture.used())
        s.specular *= clamped({read(m.specular_texture, textures, hit).a, 0, 0}).x;
    if (!m.specular_color_texture.used()) return m.specular_color;
    return m.specular_color * rgb(read(m.specular_color_texture, textures, hit));
}

/// Values above 1 are allowed: KHR_materials_specular clamps F0 later.
Spectrum specular_spectrum(Rgb c, const Wavelengths& wavelengths) {
    if (c == Rgb{1, 1, 1}) return 1.f;
    return wavelengths.reflectance(c);
}

void disperse(const GltfMaterial& m, const Wavelengths& wavelengths, GltfSurface& s) {
    if (s.ior <= 0) return;  // no refraction
    s.iors = dispersed_ior(s.ior, m.dispersion, wavelengths.nm);
    s.ior = s.iors[0];
    s.disperses = !wavelengths.secondary_ended;
}

/// Makes indices relative to the solid outside.
void become_relative(const SurfaceHit& hit, GltfSurface& s) {
    if (!s.disperses) s.iors = s.ior;
    s.ior /= hit.outside_ior, s.iors *= 1 / hit.outside_ior;
    s.disperses = s.disperses || (hit.outside_disperses && s.volume && s.transmission > 0);
}

/// The absorption of KHR_materials_volume.
Interior interior_of(const GltfMaterial& m, const Wavelengths& wavelengths) {
    if (!(m.thickness > 0) || !std::isfinite(m.attenuation_distance)) return {};
    return {true, wavelengths.reflectance(m.attenuation_color), m.attenuation_distance};
}

struct SpecularGlossiness {
    Rgb diffuse, f0;
    float glossiness;
};

/// KHR_materials_pbrSpecularGlossiness: c_diff = diffuse (1 - max(specular)).
SpecularGlossiness read_specular_glossiness(const GltfMaterial& m,
                                            const Textures& textures,
                                            const SurfaceHit& hit) {
    SpecularGlossiness s{base_color(m, textures, hit), m.specular_color, m.glossiness};
    if (m.specular_glossiness_texture.used()) {
        const Texture::Texel t = read(m.specular_glossiness_texture, textures, hit);
        s.f0 = s.f0 * rgb(t);
        s.glossiness = clamped(s.glossiness * t.a);
    }
    s.f0 = clamped(s.f0);
    s.diffuse = s.diffuse * (1 - max_component(s.f0));
    return s;
}

/// An index of 0 gives a reflectance of 1, which specular_color scales to the F0; F90 is 1.
GltfSurface specular_glossiness(const GltfMaterial& m, const Textures& textures,
                                const SurfaceHit& hit, const Wavelengths& wavelengths) {
    const SpecularGlossiness s = read_specular_glossiness(m, textures, hit);
    GltfSurface surface;
    surface.base = wavelengths.reflectance(s.diffuse);
    surface.metallic = 0;
    surface.roughness = roughened(1 - s.glossiness, hit.slope_variance);
    surface.ior = 0;
    surface.specular_color = wavelengths.reflectance(s.f0);
    return surface;
}

struct DiffuseTransmission {
    float share;
    Rgb color;
};
DiffuseTransmission read_diffuse_transmission(const GltfMaterial& m,
                                              const Textures& textures,
                                              const SurfaceHit& hit) {
    DiffuseTransmission d{m.diffuse_transmission, m.diffuse_transmission_color};
    if (m.diffuse_transmission_texture.used())
        d.share *=
            clamped(read(m.diffuse_transmission_texture, textures, hit).a);
    if (m.diffuse_transmission_color_texture.used())
        d.color =
            d.color * rgb(read(m.diffuse_transmission_color_texture, textures, hit));
    return {d.share, clamped(d.color)};
}

}  // namespace

GltfSurface gltf_surface(const GltfMaterial& m, const Textures& textures,
                         const SurfaceHit& hit, const Wavelengths& wavelengths) {
    if (m.specular_glossiness) return specular_glossiness(m, textures, hit, wavelengths);
    GltfSurface s;
    s.base = wavelengths.reflectance(base_color(m, textures, hit));
    read_metallic_roughness(m, textures, hit, s);
    s.specular_color = specular_spectrum(read_specular(m, textures, hit, s), wavelengths);
    s.transmission = m.transmission;
    if (m.transmission_texture.used())
        s.transmission *=
            clamped({read(m.transmission_texture, textures, hit).r, 0, 0}).x;
    if (m.diffuse_transmission > 0) {
        const auto d = read_diffuse_transmission(m, textures, hit);
        s.diffuse_transmission = d.share;
        s.diffuse_transmission_color = wavelengths.reflectance(d.color);
    }
    s.volume = m.thickness > 0;
    s.interior = interior_of(m, wavelengths);
    if (s.volume && m.dispersion > 0 && s.transmission > 0) disperse(m, wavelengths, s);
    if (hit.outside_ior != 1) become_relative(hit, s);
    return s;
}

SolidOptics solid_optics_of(const GltfMaterial& m, const Wavelengths& wavelengths) {
    GltfSurface s;
    s.ior = m.ior;
    if (m.dispersion > 0) disperse(m, wavelengths, s);
    return {s.ior > 0 ? s.ior : 1, s.disperses, interior_of(m, wavelengths)};
}

Rgb surface_albedo(const GltfMaterial& m, const Textures& textures, const SurfaceHit& hit) {
    if (m.specular_glossiness) {
        const SpecularGlossiness s = read_specular_glossiness(m, textures, hit);
        return s.diffuse + s.f0;
    }
    Rgb base = base_color(m, textures, hit);
    GltfSurface s;
    read_metallic_roughness(m, textures, hit, s);
    const Rgb colour = read_specular(m, textures, hit, s);
    const Rgb f0 = clamped(colour * normal_reflectance(s.ior)) * s.specular;
    const Rgb metal = base;
    if (m.diffuse_transmission > 0) {
        const auto d = read_diffuse_transmission(m, textures, hit);
        base = base * (1 - d.share) + d.color * d.share;
    }
    const Rgb dielectric = base * (1 - max_component(f0)) + f0;
    return dielectric * (1 - s.metallic) + metal * s.metallic;
}

}  // namespace dg
