// texture.h -- images on surfaces. Values are linear when they leave here.
#pragma once
#include <cstdint>
#include <string>
#include <variant>

#include "geometry/hit.h"
#include "material/mipmap.h"
#include "math/shared_array.h"
#include "math/vec.h"

namespace dg {

enum class Wrap { repeat, mirror, clamp };
enum class TextureFilter { linear, nearest };

/// Minification filter of glTF: interpolation inside a pyramid level and between levels.
struct MinFilter {
    TextureFilter within = TextureFilter::linear;
    enum class Mip { none, nearest, linear } between = Mip::linear;
};

/// An image with 8-bit (sRGB or linear) or float pixels. Row 0 is the top row; uv (0,0) is its left corner, as in glTF.
struct Texture {
    std::string name;
    int width = 0, height = 0, channels = 0;  // channels 1..4
    std::variant<SharedArray<std::uint8_t>, SharedArray<float>> pixels;
    bool srgb = false;  // decode the first three channels on lookup (8-bit only)
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::linear;  // magnification filter
    MinFilter min_filter = {};
    std::shared_ptr<const Pyramid> pyramid = {};  // null: lookups use the full resolution

    struct Texel {
        float r, g, b, a;
    };  // missing channels: grey r=g=b for 1 and 2, a = 1
    /// Lookup at any uv; NaN and infinity count as 0. An empty texture is white.
    Texel lookup(Vec2f uv) const;
    /// Filtered lookup over a footprint.
    Texel lookup(Vec2f uv, const UvFootprint& footprint) const;
    /// log2 of the footprint's width in texels; 0 or less: magnified.
    float level(const UvFootprint& footprint) const;

    /// Throws Error if the pixels are not width x height x channels, or not finite.
    void validate() const;
};

/// Use of a texture by a material slot (KHR_texture_transform included). index < 0: none.
struct TextureSlot {
    int index = -1;
    int uv_set = 0;
    // uv' = (m[0] u + m[1] v + m[2], m[3] u + m[4] v + m[5])
    float m[6] = {1, 0, 0, 0, 1, 0};
    bool used() const { return index >= 0; }
    Vec2f transform(Vec2f uv) const { return turned(uv) + Vec2f{m[2], m[5]}; }
    UvFootprint turned(const UvFootprint& f) const { return {turned(f.across), turned(f.along)}; }
    Vec2f turned(Vec2f d) const {
        return {m[0] * d.x + m[1] * d.y, m[3] * d.x + m[4] * d.y};
    }
};

}  // namespace dg
