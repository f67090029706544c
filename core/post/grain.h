// grain.h -- the pattern of film grain: noise that each pixel has by its place alone.
#pragma once
#include <cstdint>
#include <vector>

namespace dg {

struct GrainWindow {
    int x0, y0, width, height;   // px of the film
};

/// Normal numbers of mean 0 and variance 1 for the pixels of a window, row by row: so many equal round
/// grains per pixel that their number is normal, seen through square pixels. `radius`: of a grain, px. A
/// pixel's number depends on its place, seed and layer alone: the same bits in any window, on any number of
/// threads.
std::vector<float> grain_pattern(const GrainWindow& window, double radius, std::uint64_t seed, int layer);

}  // namespace dg
