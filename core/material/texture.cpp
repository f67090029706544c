// texture.cpp -- lookups: wrapping, bilinear weights, sRGB decoding.
#include "material/texture.h"

#include <array>
#include <cmath>

#include "math/error.h"

namespace dg {
namespace {

/// IEC 61966-2-1 for the 256 codes, and the linear codes beside it.
struct Decode {
    std::array<float, 256> srgb, linear;
    Decode() {
        for (int i = 0; i < 256; ++i) {
            const double v = i / 255.0;
            srgb[i] = static_cast<float>(
                v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
            linear[i] = static_cast<float>(v);
        }
    }
};
const Decode kDecode;

/// One axis: two neighbours and the weight of the second.
struct Tap {
    int low, high;
    float t;
};

/// [0,1] from any coordinate. Every comparison is false for NaN, so NaN and infinity end
/// as 0.
float wrapped(float u, Wrap wrap) {
    if (wrap == Wrap::clamp) return u > 0 ? std::min(u, 1.f) : 0.f;
    if (wrap == Wrap::repeat) {
        u -= std::floor(u);
        return u > 0 && u < 1 ? u : 0.f;
    }
    u -= 2 * std::floor(0.5f * u);
    if (u > 1) u = 2 - u;
    return u > 0 && u <= 1 ? u : 0.f;
}

Tap tap(float coordinate, int size, Wrap wrap, TextureFilter filter) {
    const float u = wrapped(coordinate, wrap) * static_cast<float>(size);
    if (filter == TextureFilter::nearest) {
        const int i = std::min(static_cast<int>(u), size - 1);
        return {i, i, 0};
    }
    // Texel centres lie at i + 1/2; u + 1/2 >= 0, so that truncation is the floor.
    const int high = std::min(static_cast<int>(u + 0.5f), size);
    const int low = high - 1;
    const float t = u - 0.5f - static_cast<float>(low);
    // Across the edge: repeat takes the other side, mirror and clamp the same texel
    // again.
    const bool repeat = wrap == Wrap::repeat;
    return {low >= 0 ? low
            : repeat ? size - 1
                     : 0,
            high < size ? high
            : repeat    ? 0
                        : size - 1,
            t};
}

using Lanes = float __attribute__((vector_size(16)));  // r, g, b, a

float value(float v, const float*) {
    return v;
}
float value(std::uint8_t v, const float* decode) {
    return decode[v];
}

template <int kChannels, typename T>
Lanes fetch(const T* p, const float* colour) {
    const float* plain = kDecode.linear.data();
    const float r = value(p[0], colour);
    if constexpr (kChannels == 1) return Lanes{r, r, r, 1};
    if constexpr (kChannels == 2) return Lanes{r, r, r, value(p[1], plain)};
    if constexpr (kChannels == 3)
        return Lanes{r, value(p[1], colour), value(p[2], colour), 1};
    if constexpr (kChannels == 4)
        return Lanes{r, value(p[1], colour), value(p[2], colour), value(p[3], plain)};
}

template <int kChannels, typename T>
Texture::Texel interpolate(const T* pixels, int width, Tap u, Tap v,
                           const float* colour) {
    const auto at = [&](int x, int y) {
        return fetch<kChannels>(
            pixels + (static_cast<std::size_t>(y) * width + x) * kChannels, colour);
    };
    const Lanes a = at(u.low, v.low), b = at(u.high, v.low);
    const Lanes c = at(u.low, v.high), d = at(u.high, v.high);
    const Lanes top = a + (b - a) * u.t, bottom = c + (d - c) * u.t;
    const Lanes t = top + (bottom - top) * v.t;
    return {t[0], t[1], t[2], t[3]};
}

template <typename T>
Texture::Texel interpolate(const Texture& texture, const SharedArray<T>& pixels,
                           Vec2f uv) {
    if (pixels.empty()) return {1, 1, 1, 1};
    const Tap u = tap(uv.x, texture.width, texture.wrap_u, texture.filter);
    const Tap v = tap(uv.y, texture.height, texture.wrap_v, texture.filter);
    const float* colour = texture.srgb ? kDecode.srgb.data() : kDecode.linear.data();
    const T* p = pixels.data();
    switch (texture.channels) {
        case 1:
            return interpolate<1>(p, texture.width, u, v, colour);
        case 2:
            return interpolate<2>(p, texture.width, u, v, colour);
        case 3:
            return interpolate<3>(p, texture.width, u, v, colour);
        default:
            return interpolate<4>(p, texture.width, u, v, colour);
    }
}

}  // namespace

Texture::Texel Texture::lookup(Vec2f uv) const {
    if (const auto* bytes = std::get_if<SharedArray<std::uint8_t>>(&pixels))
        return interpolate(*this, *bytes, uv);
    return interpolate(*this, *std::get_if<SharedArray<float>>(&pixels), uv);
}

void Texture::validate() const {
    const std::string where = "texture '" + name + "'";
    if (width < 1 || height < 1)
        throw input_error(where, "size", "at least 1 x 1",
                          std::to_string(width) + " x " + std::to_string(height));
    if (channels < 1 || channels > 4)
        throw input_error(where, "channels", "1 to 4", std::to_string(channels));
    const std::size_t wanted = static_cast<std::size_t>(width) * height * channels;
    const std::size_t got = std::visit([](const auto& p) { return p.size(); }, pixels);
    if (got != wanted)
        throw input_error(where, "pixel values", std::to_string(wanted),
                          std::to_string(got));
    if (const auto* values = std::get_if<SharedArray<float>>(&pixels))
        for (std::size_t i = 0; i < values->size(); ++i)
            if (!std::isfinite((*values)[i]))
                throw input_error(where, "pixel value " + std::to_string(i),
                                  "a finite number", std::to_string((*values)[i]));
}

}  // namespace dg
