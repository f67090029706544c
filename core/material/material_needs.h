// material_needs.h -- attributes that a material needs at a hit, and properties that are computed once per scene.
#pragma once
#include "material/material_keys.h"

namespace dg {

/// Whether the material uses a texture.
bool uses_textures(const Material& material);

/// Index of the texture coordinate set that defines the tangent (+u): the set of the normal map (glTF 2.0, 3.7.2.1), or
/// of another texture that needs a tangent. -1: no tangent needed.
int tangent_set(const Material& material);

/// Whether hits must choose a part of a mixture (SurfaceHit::choice).
bool is_mixture(const Material& material);

/// Whether the material transmits no light, apart from its opacity.
bool only_reflects(const Material& material);

/// Whether the material may cause caustics.
bool makes_caustics(const Material& material);

/// Sets the pointers of mixtures to their parts; materials and changes must not move afterwards. `changes`: per
/// material, or empty.
void link_mixtures(std::vector<Material>& materials, const std::vector<std::unique_ptr<MaterialChange>>& changes);

}  // namespace dg
