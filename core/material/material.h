// material.h -- materials of surfaces. To add a kind: a struct in surfaces.h, a bsdf_x.h/.cpp with its BSDF, an
// alternative of Bsdf and of Material::kind, and a shade_kind() in shade_surfaces.cpp.
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
    TextureSlot occlusion_texture;  // read and ignored: light transport computes occlusion
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
    /// KHR_materials_pbrSpecularGlossiness replaces the reflection parameters above: base_color is its diffuse colour,
    /// specular_color its F0.
    bool specular_glossiness = false;
    float glossiness = 1;
    TextureSlot specular_glossiness_texture;  // RGB F0, A glossiness
    /// KHR_materials_unlit: emits its base colour in cd/m2 on both sides and reflects nothing.
    bool unlit = false;
};

struct Material {
    std::string name;
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, GltfMaterial, CoatedMaterial,
                 MixMaterial, BoundaryMaterial>
        kind;
    /// Additional emission, cd/m2 (front side only, unless two_sided_emission).
    Rgb emission{0, 0, 0};
    bool two_sided_emission = false;
    std::int32_t profile = -1;  // index of the directional profile of all emission; -1: none
    float opacity = 1;          // covered fraction; times R of the texture
    TextureSlot opacity_texture = {};
    TextureSlot normal_texture = {};   // for kinds without a normal map
    float normal_scale = 1;
    bool two_sided = true;      // false: black from behind, except for emission
    TextureSlot emission_texture = {};   // RGB, a factor on `emission`
};

/// Throws Error that names the material and the field: for a factor that is not finite or out of range, or a texture
/// slot with an invalid index. Rendering relies on this check.
void validate(const Material& material, const std::vector<Texture>& textures);

/// Evaluates textures and the normal map to the BSDF at a hit. Replaces the hit's ns by the mapped normal, adjusted
/// toward ng where wo or its mirror direction would be below the surface, which would be black. Single-sided surfaces
/// are also shaded from behind, with a flipped normal, so that a camera inside a room sees walls.
Bsdf shade(const Material& material, const std::vector<Texture>& textures,
           SurfaceHit& hit, const Wavelengths& wavelengths);

/// Emitted luminance toward hit.wo as Rgb in cd/m2 (D65-shaped); 0 from behind a one-sided emitter. A clear coat
/// attenuates it (KHR_materials_clearcoat), depending on the mesh's normal in hit.ns and on hit.tangent.
Rgb emitted(const Material& material, const std::vector<Texture>& textures,
            const SurfaceHit& hit);

/// True if emission depends on the direction.
bool emission_is_coated(const Material& material);
/// Factor of all emission, and its textures. For KHR_materials_unlit these are the base colour with its texture and
/// vertex colours.
Rgb emission_factor(const Material& material);
std::array<TextureSlot, 2> emission_textures(const Material& material);
/// Whether it also emits from behind.
bool emits_from_behind(const Material& material);

/// True if the material may emit; light/ computes means over triangles.
bool emits(const Material& material);

/// Strongest straight transmission anywhere on the material, for shadow rays. Never weaker than
/// straight_transmittance() of its BSDFs.
Clear clearness(const Material& material);

/// True if it has a normal map.
bool has_normal_map(const Material& material);
/// Whether closed meshes of a material, or of a part of a mixture, are refracting solids.
bool bounds_solid(const Material& material);
/// Index at the hero wavelength, and absorption, of the inside of a solid.
struct SolidOptics {
    float ior = 1;
    bool disperses = false;
    Interior interior{};
};
SolidOptics solid_optics(const Material& material, const Wavelengths& wavelengths);

/// True if it, or a part of a mixture, is black from behind.
bool is_one_sided(const Material& material);

/// False if the material is opaque everywhere, so that rays need no opacity test.
bool has_cutout(const Material& material, const std::vector<Texture>& textures);
/// Opacity in [0,1] at uv, including vertex colour alpha; 1 for opaque materials, 0 or 1 for masks. `time`: for
/// animated parts of mixtures.
float opacity(const Material& material, const std::vector<Texture>& textures,
              const Vec2f uv[2], float vertex_alpha, float time = 0);

/// Diffuse + specular albedo for the `albedo` AOV (Rgb, first hit).
Rgb albedo(const Material& material, const std::vector<Texture>& textures,
           const SurfaceHit& hit);

}  // namespace dg
