// pyramids.h -- builds the mip pyramids of a scene's textures.
#pragma once
#include "material/material.h"

namespace dg {

/// Builds the pyramid of each texture with a mipmap filter, in parallel. Weights colours by alpha if a material uses
/// alpha as opacity, so that invisible transparent texels do not darken e.g. the rim of a leaf. Textures with the same
/// pixels share a pyramid.
void build_pyramids(std::vector<Texture>& textures, const std::vector<Material>& materials);

}  // namespace dg
