// material_read.h -- texture and normal lookups at a hit, internal to this folder.
#pragma once
#include "material/material.h"

namespace dg {

using Textures = std::vector<Texture>;

/// Filtered lookup over the footprint of the ray cone.
inline Texture::Texel read(const TextureSlot& slot, const Textures& textures,
                           const SurfaceHit& hit) {
    return textures[slot.index].lookup(slot.transform(hit.uv[slot.uv_set]),
                                       slot.turned(hit.footprint[slot.uv_set]));
}
/// Unfiltered lookup at the point. Textures that determine whether glass is clear need it: shadow rays have no cone,
/// and if a path scattered at glass that shadow rays passed unscattered, the light behind would count twice.
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

/// ns, or the nearest normal between ns and ng for which wo and its mirror direction are above the surface, at least a
/// tenth as high as wo. Otherwise normal maps, and interpolated normals at silhouettes, would be black where they face
/// away from the viewer.
Vec3f visible_normal(Vec3f ns, Vec3f ng, Vec3f wo);

/// ns of a normal map on a matte surface, which has no mirror direction and keeps steep normals. A normal that faces
/// away from wo belongs to a hidden slope. It is rotated by half a turn about ng, to the visible opposite slope, as in
/// pbrt and Mitsuba.
Vec3f facing_normal(Vec3f ns, Vec3f ng, Vec3f wo);

// The extensions of gltf_layers.h at a hit. hit.ns is the normal of the mesh for read_coat, and the normal of the base
// for read_anisotropy.
Coat read_coat(const ClearcoatLayer& layer, const Textures& textures,
               const SurfaceHit& hit);
/// Factor of the coat, including its texture.
float coat_factor(const ClearcoatLayer& layer, const Textures& textures,
                  const SurfaceHit& hit);
Vec3f coat_normal(const ClearcoatLayer& layer, const Textures& textures,
                  const SurfaceHit& hit);
Rgb sheen_color(const SheenLayer& layer, const Textures& textures, const SurfaceHit& hit);
float sheen_roughness(const SheenLayer& layer, const Textures& textures,
                      const SurfaceHit& hit);
void read_anisotropy(const Anisotropy& a, const Textures& textures, const SurfaceHit& hit,
                     GltfSurface& s);
/// `outside`: index above the film.
void read_iridescence(const Iridescence& i, const Textures& textures,
                      const SurfaceHit& hit, float outside, Spectrum wavelengths_nm,
                      GltfSurface& s);

}  // namespace dg
