// material.h -- what surfaces are made of. Adding a kind: a struct in surfaces.h, a bsdf_x.h/.cpp
// with its BSDF, an alternative in both variants, and a shade_kind() in shade_surfaces.cpp.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "geometry/crossings.h"
#include "geometry/hit.h"
#include "material/bsdf.h"
#include "material/gltf_layers.h"
#include "material/surfaces.h"
#include "material/texture.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// glTF 2.0 metallic-roughness with KHR_materials_{anisotropy, clearcoat, dispersion,
/// emissive_strength, ior, iridescence, sheen, specular, transmission, volume}; formulas
/// of glTF 2.0 Appendix B and of the extensions.
struct GltfMaterial {
    Rgb base_color{1, 1, 1};
    float base_alpha = 1;
    TextureSlot base_color_texture;
    float metallic = 1, roughness = 1;
    TextureSlot metallic_roughness_texture;  // G roughness, B metallic
    float normal_scale = 1;
    TextureSlot normal_texture;
    TextureSlot occlusion_texture;  // read, and not used: light transport does it
    Rgb emissive{0, 0, 0};          // factor x strength, cd/m2
    TextureSlot emissive_texture;
    enum class AlphaMode { opaque, mask, blend } alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    float ior = 1.5f;
    float specular = 1;
    TextureSlot specular_texture;  // A
    Rgb specular_color{1, 1, 1};
    TextureSlot specular_color_texture;  // RGB
    float transmission = 0;
    TextureSlot transmission_texture;  // R
    float thickness = 0;               // > 0: a volume with refraction; 0: thin-walled
    float attenuation_distance = std::numeric_limits<float>::infinity();  // m
    Rgb attenuation_color{1, 1, 1};
    float dispersion = 0;  // 20 / Abbe number; of a volume
    ClearcoatLayer clearcoat;
    SheenLayer sheen;
    Anisotropy anisotropy;
    Iridescence iridescence;
    float diffuse_transmission = 0;
    TextureSlot diffuse_transmission_texture;  // A
    Rgb diffuse_transmission_color{1, 1, 1};
    TextureSlot diffuse_transmission_color_texture;  // RGB
    /// KHR_materials_pbrSpecularGlossiness instead of all of the above that reflects:
    /// base_color is its diffuse colour, specular_color its F0.
    bool specular_glossiness = false;
    float glossiness = 1;
    TextureSlot specular_glossiness_texture;  // RGB F0, A glossiness
    /// KHR_materials_unlit: shines with its base colour in cd/m2 and reflects nothing. From
    /// both sides, as surfaces are shaded from behind too.
    bool unlit = false;
};

struct Material {
    std::string name;
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, GltfMaterial, CoatedMaterial,
                 MixMaterial, BoundaryMaterial>
        kind;
    /// Extra emission of any kind, cd/m2 (front side only, unless two_sided_emission).
    Rgb emission{0, 0, 0};
    bool two_sided_emission = false;
    std::int32_t profile = -1;  // of all emission, by direction; index, -1: none
    float opacity = 1;          // share of it that is there; times R of the texture
    TextureSlot opacity_texture = {};
    TextureSlot normal_texture = {};   // of kinds that have none of their own
    float normal_scale = 1;
    bool two_sided = true;      // false: black from behind, emission aside
    TextureSlot emission_texture = {};   // RGB, a factor on `emission`
};

/// Throws Error naming the material and the field: a factor that is not finite or out of
/// its range, a texture slot that points at no texture. What passes here is not looked at
/// again in the loop.
void validate(const Material& material, const std::vector<Texture>& textures);

/// BSDF at a hit: textures read, normal map applied. The hit's ns is replaced by the
/// mapped normal, bent toward ng where wo or its mirror image would fall below the
/// surface (that would be black). Single-sided surfaces are shaded from behind too, with
/// the normal turned round: a camera inside a room sees walls.
Bsdf shade(const Material& material, const std::vector<Texture>& textures,
           SurfaceHit& hit, const Wavelengths& wavelengths);

/// Emitted radiance toward hit.wo as Rgb in cd/m2 (D65-shaped); 0 from the back of a
/// one-sided emitter. A clear coat takes its share (KHR_materials_clearcoat), by the mesh's
/// normal in hit.ns and by hit.tangent.
Rgb emitted(const Material& material, const std::vector<Texture>& textures,
            const SurfaceHit& hit);

/// True when emission changes with the direction it is seen from.
bool emission_is_coated(const Material& material);
/// Factor of all emission, and its textures. Of a glTF material's that of KHR_materials_unlit is its base
/// colour, and vertex colours count there too.
Rgb emission_factor(const Material& material);
std::array<TextureSlot, 2> emission_textures(const Material& material);
/// From behind as well.
bool emits_from_behind(const Material& material);

/// True when the material emits at all; the mean over a triangle is light/'s business.
bool emits(const Material& material);

/// Ways in which light may go straight on through at some point of the material: never less than
/// its BSDFs' straight_transmittance() says.
Clear clearness(const Material& material);

/// True when a texture bends its normals.
bool has_normal_map(const Material& material);
/// True when it is black from behind, or a part of it is.
bool is_one_sided(const Material& material);

/// False where the material is opaque everywhere, so that rays need not ask.
bool has_cutout(const Material& material, const std::vector<Texture>& textures);
/// Opacity in [0,1] at uv with vertex colour alpha; 1 for opaque materials. mask gives 0
/// or 1. `time`: for parts of mixtures that change.
float opacity(const Material& material, const std::vector<Texture>& textures,
              const Vec2f uv[2], float vertex_alpha, float time = 0);

/// Diffuse + specular albedo for the `albedo` AOV (Rgb, first hit).
Rgb albedo(const Material& material, const std::vector<Texture>& textures,
           const SurfaceHit& hit);

}  // namespace dg
