// picture.h -- development of recorded channels into an image, in one pass over its pixels.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "develop/curve.h"
#include "math/vec.h"

namespace dg {

/// Treatment of pixels with saturated channels. clip: all channels clip where the first is full, so
/// white stays white. blend: light above the clipping point keeps its mean, with at most the
/// saturation that `clip` leaves. reconstruct: a full channel takes the mean of the other channels
/// if that is higher, since highlights are lamps and their reflections, which are mostly white.
enum class HighlightRule { clip, blend, reconstruct };

/// Parses the name. Throws Error.
HighlightRule highlights_of(std::string_view name);

struct Development {
    Vec3f balance{1, 1, 1};   // gain per channel that makes neutrals equal in all channels
    Vec3f full{kNever, kNever, kNever};   // saturation level of the channels before balance
    HighlightRule highlights = HighlightRule::clip;
    std::array<float, 9> rgb_from_balanced{1, 0, 0, 0, 1, 0, 0, 0, 1};   // linear, white is 1; row-major
    Vec3f luminance{0.2126f, 0.7152f, 0.0722f};   // of linear R, G, B
    std::optional<Curve> tone;     // scene to display, both linear; absent: clipped at 1
    std::optional<Curve> encode;   // display to file values; absent: scene-linear, unbounded colours

    static constexpr float kNever = std::numeric_limits<float>::infinity();
};

/// Raises negative components to 0 by mixing with the neutral of equal luminance; black without
/// light.
Vec3f into_gamut(const Vec3f& rgb, const Vec3f& luminance);

/// Maps colours with a component above 1: clips at constant chromaticity, then desaturates toward
/// white with increasing brightness, halfway at five times white. Film and eye behave alike.
Vec3f below_white(const Vec3f& rgb);

/// Develops pixels of three numbers from `in` to `out`. Parallel over rows; bitwise equal for any
/// number of threads.
void develop(const Development& how, std::span<const std::uint16_t> in, std::span<float> out);
void develop(const Development& how, std::span<const float> in, std::span<float> out);

}  // namespace dg
