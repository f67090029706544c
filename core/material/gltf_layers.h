// gltf_layers.h -- parameters of the glTF extensions for layers, with the channels of their textures.
#pragma once
#include "material/texture.h"
#include "spectrum/spectrum.h"

namespace dg {

/// KHR_materials_clearcoat.
struct ClearcoatLayer {
    float factor = 0;
    TextureSlot texture;  // R
    float roughness = 0;
    TextureSlot roughness_texture;  // G
    float normal_scale = 1;
    TextureSlot normal_texture;  // none: the coat uses the normal of the mesh, not of the base
    bool used() const { return factor > 0; }
};

/// KHR_materials_sheen.
struct SheenLayer {
    Rgb color{0, 0, 0};
    TextureSlot color_texture;  // RGB
    float roughness = 0;
    TextureSlot roughness_texture;  // A
    bool used() const { return color != Rgb{0, 0, 0}; }
};

/// KHR_materials_anisotropy.
struct Anisotropy {
    float strength = 0;
    float rotation = 0;   // rad, counter-clockwise from the tangent
    TextureSlot texture;  // RG direction, B strength
    bool used() const { return strength > 0; }
};

/// KHR_materials_iridescence.
struct Iridescence {
    float factor = 0;
    TextureSlot texture;  // R
    float ior = 1.3f;
    float thickness_min = 100, thickness_max = 400;  // nm
    TextureSlot thickness_texture;  // G, from min to max; none: max
    bool used() const { return factor > 0; }
};

}  // namespace dg
