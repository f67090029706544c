// texture.cpp -- texture lookups: level, wrapping, bilinear weights, sRGB decoding.
#include "material/texture.h"

#include <cmath>

#include "material/srgb.h"
#include "math/error.h"

namespace dg {
namespace {

/// Two neighbours along an axis and the weight of the second.
struct Tap {
    int low, high;
    float t;
};

/// Wraps a coordinate to [0,1]. Comparisons are false for NaN, so NaN and infinity give 0.
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
    // Texel centers are at i + 1/2. As u + 1/2 >= 0, truncation is the floor.
    const int high = std::min(static_cast<int>(u + 0.5f), size);
    const int low = high - 1;
    const float t = u - 0.5f - static_cast<float>(low);
    // At the edge, repeat uses the opposite side; mirror and clamp use the same texel again.
    const bool repeat = wrap == Wrap::repeat;
    return {low >= 0 ? low
            : repeat ? size - 1
                     : 0,
            high < size ? high
            : repeat    ? 0
                        : size - 1,
            t};
}

// Largest aspect ratio of a footprint: docs/textures.md.
constexpr float kAnisotropy = 4;

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

/// A level of a texture.
template <typename T>
struct Level {
    const T* pixels;
    int width, height;
};

template <typename T>
Texture::Texel interpolate(const Texture& texture, Level<T> l, Vec2f uv,
                           TextureFilter filter) {
    const Tap u = tap(uv.x, l.width, texture.wrap_u, filter);
    const Tap v = tap(uv.y, l.height, texture.wrap_v, filter);
    const float* colour = texture.srgb ? kDecode.srgb.data() : kDecode.linear.data();
    switch (texture.channels) {
        case 1:
            return interpolate<1>(l.pixels, l.width, u, v, colour);
        case 2:
            return interpolate<2>(l.pixels, l.width, u, v, colour);
        case 3:
            return interpolate<3>(l.pixels, l.width, u, v, colour);
        default:
            return interpolate<4>(l.pixels, l.width, u, v, colour);
    }
}

template <typename T>
Level<T> full(const Texture& t, const SharedArray<T>& pixels) {
    return {pixels.data(), t.width, t.height};
}

/// Level 0 is the texture itself.
template <typename T>
Level<T> choose(const Texture& t, const SharedArray<T>& pixels, int i) {
    if (i == 0) return full(t, pixels);
    const Pyramid::Level& level = t.pyramid->levels[i - 1];
    const auto& values = *std::get_if<std::vector<T>>(&t.pyramid->values);
    return {values.data() + level.offset, level.width, level.height};
}

Texture::Texel mix(const Texture::Texel& a, const Texture::Texel& b, float t) {
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t,
            a.a + (b.a - a.a) * t};
}

template <typename T>
Texture::Texel minified(const Texture& t, const SharedArray<T>& pixels, Vec2f uv, float level) {
    const TextureFilter filter = t.min_filter.within;
    const bool levels = t.pyramid && t.min_filter.between != MinFilter::Mip::none;
    const int top = levels ? static_cast<int>(t.pyramid->levels.size()) : 0;
    const float l = std::min(level, float(top));
    if (t.min_filter.between != MinFilter::Mip::linear)
        return interpolate(t, choose(t, pixels, static_cast<int>(l + 0.5f)), uv, filter);
    const int low = static_cast<int>(l);
    const Texture::Texel sharp = interpolate(t, choose(t, pixels, low), uv, filter);
    if (low == top) return sharp;
    return mix(sharp, interpolate(t, choose(t, pixels, low + 1), uv, filter), l - float(low));
}

template <typename F>
Texture::Texel read(const Texture& t, F f) {
    const auto guarded = [&](const auto& pixels) {
        return pixels.empty() ? Texture::Texel{1, 1, 1, 1} : f(pixels);
    };
    if (const auto* bytes = std::get_if<SharedArray<std::uint8_t>>(&t.pixels))
        return guarded(*bytes);
    return guarded(*std::get_if<SharedArray<float>>(&t.pixels));
}

}  // namespace

Texture::Texel Texture::lookup(Vec2f uv) const {
    return read(*this, [&](const auto& p) { return interpolate(*this, full(*this, p), uv, filter); });
}

Texture::Texel Texture::lookup(Vec2f uv, const UvFootprint& footprint) const {
    const float l = level(footprint);
    if (!(l > 0)) return lookup(uv);  // NaN too
    return read(*this, [&](const auto& p) { return minified(*this, p, uv, l); });
}

// The shorter axis of the footprint determines the level, to avoid blur along it. Footprints longer than kAnisotropy
// times their width are widened, as the samples of a pixel could not cover them.
float Texture::level(const UvFootprint& f) const {
    const auto squared = [&](Vec2f axis) {
        return length_squared(Vec2f{axis.x * float(width), axis.y * float(height)});
    };
    const float a = squared(f.across), b = squared(f.along);
    const float w2 = std::max(std::min(a, b), std::max(a, b) / (kAnisotropy * kAnisotropy));
    return w2 > 1 ? 0.5f * std::log2(w2) : 0;
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
