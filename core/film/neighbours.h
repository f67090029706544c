// neighbours.h -- what the neighbours of a pixel say, where the pixel itself must not be asked.
#pragma once
#include <span>
#include <vector>

namespace dg {

/// Mean over those pixels within `reach` to each side that have the next of three colours, each by the
/// inverse square of its distance, of a plane in rows of `width`. Diagonals have one colour,
/// (x + 2 y) mod 3, so no pixel asks itself, nor one that asks it. Where nobody can be asked: the mean of
/// the plane.
std::vector<float> mean_of_next_colour(std::span<const float> plane, int width, int reach);

}  // namespace dg
