// mipmap.h -- a texture at half the size, at a quarter, ... down to one texel.
// Source: Williams 1983, Pyramidal Parametrics, SIGGRAPH.
#pragma once
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace dg {

struct Texture;

/// Levels 1, 2, ...: floor of half the size, at least 1. Values are stored as in the texture
/// (8-bit stays 8-bit, sRGB stays sRGB); a third of its memory.
struct Pyramid {
    struct Level {
        int width, height;
        std::size_t offset;  // of its first value
    };
    std::vector<Level> levels;
    std::variant<std::vector<std::uint8_t>, std::vector<float>> values;
};

/// Means are taken in linear light and over exactly the area of a texel, also where a size is
/// odd; so the mean of every level is that of the texture, whatever its wrap.
/// `weigh_by_alpha`: colours count by their alpha, for textures whose transparent texels are
/// never seen. Null for 1 x 1.
std::shared_ptr<const Pyramid> build_pyramid(const Texture& texture, bool weigh_by_alpha);

}  // namespace dg
