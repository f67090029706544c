// mipmap.h -- mip pyramid of a texture, down to a single texel.
// Source: Williams 1983, Pyramidal Parametrics, SIGGRAPH.
#pragma once
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace dg {

struct Texture;

/// Levels 1, 2, ... have half the size of the level before, rounded down, at least 1. Values are stored in the format
/// of the texture (8-bit, sRGB); needs a third of its memory.
struct Pyramid {
    struct Level {
        int width, height;
        std::size_t offset;  // index of its first value
    };
    std::vector<Level> levels;
    std::variant<std::vector<std::uint8_t>, std::vector<float>> values;
};

/// Averages linear light over the exact area of a texel, also for odd sizes, so every level has the mean of the
/// texture, for any wrap mode. `weigh_by_alpha`: weights colours by alpha, for textures with invisible transparent
/// texels. Null for 1 x 1.
std::shared_ptr<const Pyramid> build_pyramid(const Texture& texture, bool weigh_by_alpha);

}  // namespace dg
