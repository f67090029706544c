// sharpen.h -- unsharp mask.
#pragma once
#include <span>

namespace dg {

/// Adds to each pixel, equally in all channels, `amount` times the difference between its luminance
/// (weights for R, G, B) and the luminance blurred by a Gaussian of standard deviation `radius` px.
/// Edge pixels are repeated outside of the image. In place.
void sharpen(std::span<float> rgb, int width, int height, const float (&luminance)[3], float amount, float radius);

}  // namespace dg
