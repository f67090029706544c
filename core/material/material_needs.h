// material_needs.h -- what a material wants to know of a hit, and what is decided once for a scene.
#pragma once
#include "material/material_keys.h"

namespace dg {

/// Whether any texture is looked at.
bool uses_textures(const Material& material);

/// The texture set whose +u is the tangent, for a material that has need of one: that of the normal map (glTF 2.0,
/// 3.7.2.1), or else of what takes its place. -1: no need.
int tangent_set(const Material& material);

/// Whether hits must choose a part (SurfaceHit::choice).
bool is_mixture(const Material& material);

/// Whether light is bent or mirrored so that it gathers.
bool makes_caustics(const Material& material);

/// Lets the mixtures know where their parts are. Materials and changes stay where they are from then on. `changes`: by
/// material, or empty.
void link_mixtures(std::vector<Material>& materials, const std::vector<std::unique_ptr<MaterialChange>>& changes);

}  // namespace dg
