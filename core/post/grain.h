// grain.h -- film grain: noise as a function of the pixel position.
#pragma once
#include <cstdint>
#include <vector>

namespace dg {

struct GrainWindow {
    int x0, y0, width, height;   // px of the film
};

/// Correlated normal numbers of mean 0 and variance 1 for the pixels of a window, row-major: the
/// limit of many equal round grains per pixel, integrated over square pixels. `radius`: of a grain,
/// px. A value depends only on position, seed and layer: bitwise equal for any window and number of
/// threads.
std::vector<float> grain_pattern(const GrainWindow& window, double radius, std::uint64_t seed, int layer);

}  // namespace dg
