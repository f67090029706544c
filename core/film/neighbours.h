// neighbours.h -- estimates for a pixel from its neighbours alone.
#pragma once
#include <span>
#include <vector>

namespace dg {

/// For each pixel of a plane in rows of `width`, the mean over the pixels within `reach` px along x and y
/// that have the next of three colours, weighted by 1 / distance^2. The colour of a pixel is
/// (x + 2 y) mod 3, so a mean depends neither on the pixel itself nor on pixels that depend on it. A pixel
/// without such neighbours gets the mean of the plane.
std::vector<float> mean_of_next_colour(std::span<const float> plane, int width, int reach);

}  // namespace dg
