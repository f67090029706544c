// pyramids.h -- the smaller copies of a scene's textures, before anything is drawn.
#pragma once
#include "material/material.h"

namespace dg {

/// Builds the pyramid of each texture whose filter asks for one, side by side. Colours count
/// by their alpha where a material cuts out or blends by it: what is transparent is not seen,
/// and must not darken the rim of a leaf. Textures with the same pixels share one.
void build_pyramids(std::vector<Texture>& textures, const std::vector<Material>& materials);

}  // namespace dg
