// material_read.h -- reading textures and normals at a hit, for this room's own files.
#pragma once
#include "material/material.h"

namespace dg {

using Textures = std::vector<Texture>;

/// The mean over what the ray's cone covers.
inline Texture::Texel read(const TextureSlot& slot, const Textures& textures,
                           const SurfaceHit& hit) {
    return textures[slot.index].lookup(slot.transform(hit.uv[slot.uv_set]),
                                       slot.turned(hit.footprint[slot.uv_set]));
}
/// At the point itself. So is read what decides whether glass is clear there: shadow rays
/// have no cone, and a path must not scatter at glass that they went straight through, or
/// the light behind it counts twice.
inline Texture::Texel read_point(const TextureSlot& slot, const Textures& textures,
                                 const SurfaceHit& hit) {
    return textures[slot.index].lookup(slot.transform(hit.uv[slot.uv_set]));
}
inline Rgb rgb(const Texture::Texel& t) {
    return {t.r, t.g, t.b};
}
inline float clamped(float v) {
    return v > 0 ? std::min(v, 1.f) : 0.f;  // NaN is 0
}
inline Rgb clamped(Rgb c) {
    return {clamped(c.x), clamped(c.y), clamped(c.z)};
}

/// Normal map (glTF 2.0, 3.9.3): xy scaled, in the frame (tangent, bitangent, normal). On
/// the front side of the surface, like hit.ns.
Vec3f mapped_normal(const TextureSlot& slot, float scale, const Textures& textures,
                    const SurfaceHit& hit);

/// ns, or what lies nearest to it on the way to ng from where both wo and its mirror
/// image are above the surface: at least a tenth as high as wo itself. Without this,
/// normal maps and interpolated normals at silhouettes are black where they turn away
/// from the viewer.
Vec3f visible_normal(Vec3f ns, Vec3f ng, Vec3f wo);

/// ns of a normal map on a matte surface, which has no mirror image and keeps steep normals. One that faces away from
/// wo belongs to a slope that is hidden; what is seen in its place is the slope across, turned half about ng, as pbrt
/// and Mitsuba have it.
Vec3f facing_normal(Vec3f ns, Vec3f ng, Vec3f wo);

// The extensions of gltf_layers.h at a hit; hit.ns is the normal of the mesh for
// read_coat, that of the base for read_anisotropy.
Coat read_coat(const ClearcoatLayer& layer, const Textures& textures,
               const SurfaceHit& hit);
/// Factor of the coat alone, texture and all.
float coat_factor(const ClearcoatLayer& layer, const Textures& textures,
                  const SurfaceHit& hit);
Vec3f coat_normal(const ClearcoatLayer& layer, const Textures& textures,
                  const SurfaceHit& hit);
Rgb sheen_color(const SheenLayer& layer, const Textures& textures, const SurfaceHit& hit);
float sheen_roughness(const SheenLayer& layer, const Textures& textures,
                      const SurfaceHit& hit);
void read_anisotropy(const Anisotropy& a, const Textures& textures, const SurfaceHit& hit,
                     GltfSurface& s);
/// `outside`: index of what lies above the film.
void read_iridescence(const Iridescence& i, const Textures& textures,
                      const SurfaceHit& hit, float outside, Spectrum wavelengths_nm,
                      GltfSurface& s);

}  // namespace dg
