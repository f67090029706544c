// gltf_layers.cpp -- layer parameters at a hit: factors times textures.
#include "material/material_read.h"

namespace dg {

float coat_factor(const ClearcoatLayer& layer, const Textures& textures,
                  const SurfaceHit& hit) {
    if (!layer.texture.used()) return layer.factor;
    return layer.factor * clamped(read(layer.texture, textures, hit).r);
}

Vec3f coat_normal(const ClearcoatLayer& layer, const Textures& textures,
                  const SurfaceHit& hit) {
    const Vec3f ns = layer.normal_texture.used()
                         ? mapped_normal(layer.normal_texture, layer.normal_scale,
                                         textures, hit)
                         : hit.ns;
    return visible_normal(ns, hit.ng, hit.wo);
}

Coat read_coat(const ClearcoatLayer& layer, const Textures& textures,
               const SurfaceHit& hit) {
    float roughness = layer.roughness;
    if (layer.roughness_texture.used())
        roughness *= clamped(read(layer.roughness_texture, textures, hit).g);
    return {coat_normal(layer, textures, hit), coat_factor(layer, textures, hit),
            roughness * roughness};
}

Rgb sheen_color(const SheenLayer& layer, const Textures& textures,
                const SurfaceHit& hit) {
    if (!layer.color_texture.used()) return layer.color;
    return layer.color * clamped(rgb(read(layer.color_texture, textures, hit)));
}

float sheen_roughness(const SheenLayer& layer, const Textures& textures,
                      const SurfaceHit& hit) {
    if (!layer.roughness_texture.used()) return layer.roughness;
    return layer.roughness * clamped(read(layer.roughness_texture, textures, hit).a);
}

void read_anisotropy(const Anisotropy& a, const Textures& textures, const SurfaceHit& hit,
                     GltfSurface& s) {
    Vec2f direction{1, 0};
    s.anisotropy = a.strength;
    if (a.texture.used()) {
        const Texture::Texel t = s.transmission > 0 ? read_point(a.texture, textures, hit)
                                                    : read(a.texture, textures, hit);
        s.anisotropy *= clamped(t.b);
        const Vec2f d{2 * t.r - 1, 2 * t.g - 1};
        const float l2 = length_squared(d);
        if (l2 > 1e-12f) direction = d * (1 / std::sqrt(l2));
    }
    const float c = std::cos(a.rotation), sine = std::sin(a.rotation);
    const Vec2f turned{c * direction.x - sine * direction.y,
                       sine * direction.x + c * direction.y};
    // The tangent belongs to the normal of the mesh, but the lobe is around the mapped normal.
    const Vec3f bitangent = cross(hit.ns, hit.tangent) * hit.tangent_sign;
    const Vec3f along = hit.tangent * turned.x + bitangent * turned.y;
    const Vec3f t = along - hit.ns * dot(along, hit.ns);
    const float l2 = length_squared(t);
    s.tangent = l2 > 1e-8f ? t / std::sqrt(l2) : Frame::from_normal(hit.ns).x;
}

void read_iridescence(const Iridescence& i, const Textures& textures,
                      const SurfaceHit& hit, float outside, Spectrum wavelengths_nm,
                      GltfSurface& s) {
    s.iridescence = i.factor;
    if (i.texture.used())
        s.iridescence *= clamped(read(i.texture, textures, hit).r);
    float share = 1;
    if (i.thickness_texture.used())
        share = clamped(read(i.thickness_texture, textures, hit).g);
    const float thickness =
        i.thickness_min + share * (i.thickness_max - i.thickness_min);
    s.film = {i.ior, thickness, outside, wavelengths_nm};
}

}  // namespace dg
