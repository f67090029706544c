// picture.h -- from what channels recorded to the numbers of a picture, in one pass over its pixels.
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

/// Treatment of pixels in which a channel is full.
/// clip: every channel ends where the first one is full, so that white stays white.
/// blend: light above that end keeps its mean, with no more colour than `clip` leaves.
/// reconstruct: a full channel is what the others are on average, if that is more: highlights are lamps
/// and their reflections, which are mostly white.
enum class HighlightRule { clip, blend, reconstruct };

/// By name. Throws Error.
HighlightRule highlights_of(std::string_view name);

struct Development {
    Vec3f balance{1, 1, 1};   // of each channel: after it, the neutral has three equal numbers
    Vec3f full{kNever, kNever, kNever};   // where channels are full, before balance
    HighlightRule highlights = HighlightRule::clip;
    std::array<float, 9> rgb_from_balanced{1, 0, 0, 0, 1, 0, 0, 0, 1};   // linear, white is 1; row by row
    Vec3f luminance{0.2126f, 0.7152f, 0.0722f};   // of linear R, G, B
    std::optional<Curve> tone;     // scene to display, both linear; absent: as it is up to 1
    std::optional<Curve> encode;   // display to numbers of the file; absent: scene-linear, of any colour

    static constexpr float kNever = std::numeric_limits<float>::infinity();
};

/// Brings negative numbers to 0 on the way to the neutral of the same luminance; without light it is black.
Vec3f into_gamut(const Vec3f& rgb, const Vec3f& luminance);

/// Colours of which a number is above 1, with their chromaticity as bright as they can be, and then the nearer to
/// white the brighter they were: half way at five times. Film and eye do likewise.
Vec3f below_white(const Vec3f& rgb);

/// Pixels of three numbers each, `out` in the place of `in`. Rows in parallel; the same bits on any number of
/// threads.
void develop(const Development& how, std::span<const std::uint16_t> in, std::span<float> out);
void develop(const Development& how, std::span<const float> in, std::span<float> out);

}  // namespace dg
