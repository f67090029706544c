// sharpen.h -- an unsharp mask.
#pragma once
#include <span>

namespace dg {

/// Adds to each pixel, in all three colours, `amount` times what its brightness (by `luminance` of R, G, B)
/// stands above that of its surroundings, a Gaussian of standard deviation `radius` px. Edges of the picture
/// are continued by their last pixels. In place.
void sharpen(std::span<float> rgb, int width, int height, const float (&luminance)[3], float amount, float radius);

}  // namespace dg
