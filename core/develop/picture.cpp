#include "develop/picture.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr float kTop = 1e30f;            // clamp of light; sums stay finite
constexpr float kFull = 0.985f;          // noise and rounding keep saturated channels slightly below 1
constexpr float kHalfWhite = 4;          // excess over white at which a colour is halfway to white
constexpr std::size_t kPixels = 4096;    // per task

float smallest(const Vec3f& v) { return std::min({v.x, v.y, v.z}); }

/// Interpolates from the neutral of luminance y (t = 0) to a colour (t = 1).
Vec3f from_neutral(const Vec3f& rgb, float y, float t) {
    return {y + t * (rgb.x - y), y + t * (rgb.y - y), y + t * (rgb.z - y)};
}

Vec3f capped(const Vec3f& v, float top) { return {std::min(v.x, top), std::min(v.y, top), std::min(v.z, top)}; }

/// Keeps mean and hue, but limits the saturation to the saturation of the clipped channels: zero
/// where all channels are full, while red lamps stay red.
Vec3f blended(const Vec3f& v, const Vec3f& full) {
    const Vec3f ended = capped(v, smallest(full));
    const float mean = (v.x + v.y + v.z) / 3, ended_mean = (ended.x + ended.y + ended.z) / 3;
    const Vec3f colour = v - Vec3f{mean, mean, mean}, less = ended - Vec3f{ended_mean, ended_mean, ended_mean};
    const float was = dot(colour, colour), is = dot(less, less);
    return from_neutral(v, mean, was > is ? std::sqrt(is / was) : 1);
}

Vec3f reconstructed(const Vec3f& v, const Vec3f& full) {
    const float value[3] = {v.x, v.y, v.z}, end[3] = {full.x, full.y, full.z};
    float sum = 0, count = 0;
    for (int k = 0; k < 3; ++k)
        if (value[k] < kFull * end[k]) sum += value[k], count += 1;
    if (count == 3) return v;
    const float others = count > 0 ? sum / count : max_component(full);
    float out[3];
    for (int k = 0; k < 3; ++k)
        out[k] = value[k] < kFull * end[k] ? value[k] : std::max(value[k], others);
    return {out[0], out[1], out[2]};
}

Vec3f restrained(const Vec3f& balanced, const Vec3f& full, HighlightRule highlights) {
    if (std::isinf(full.x)) return balanced;
    if (highlights == HighlightRule::blend) return blended(balanced, full);
    if (highlights == HighlightRule::reconstruct) return reconstructed(balanced, full);
    return capped(balanced, smallest(full));
}

Vec3f times(const std::array<float, 9>& m, const Vec3f& v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
            m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

/// Applies the curve to the largest and smallest component; the middle component keeps its relative
/// position, which preserves the hue.
Vec3f toned(const Curve& tone, const Vec3f& rgb) {
    const float high = max_component(rgb), low = smallest(rgb);
    const float top = tone(high), bottom = tone(low);
    const float slope = high > low ? (top - bottom) / (high - low) : 0;
    auto value = [&](float x) { return bottom + slope * (x - low); };
    return {value(rgb.x), value(rgb.y), value(rgb.z)};
}

float usable(float x) { return x == x ? std::clamp(x, -kTop, kTop) : 0; }

Vec3f developed(const Development& how, const Vec3f& full, const Vec3f& in) {
    const Vec3f channels = Vec3f{usable(in.x), usable(in.y), usable(in.z)} * how.balance;
    const Vec3f linear = times(how.rgb_from_balanced, restrained(channels, full, how.highlights));
    if (!how.encode) return linear;
    const Vec3f real = into_gamut(linear, how.luminance);
    const Vec3f shown = how.tone ? toned(*how.tone, real) : below_white(real);
    return {(*how.encode)(shown.x), (*how.encode)(shown.y), (*how.encode)(shown.z)};
}

template <typename T>
void develop_all(const Development& how, std::span<const T> in, std::span<float> out) {
    if (in.size() != out.size() || in.size() % 3)
        throw input_error("develop", "pixels", std::to_string(in.size()) + " numbers", std::to_string(out.size()));
    const Vec3f full = how.full * how.balance;
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, in.size() / 3, kPixels), [&](const auto& range) {
            for (std::size_t i = 3 * range.begin(); i < 3 * range.end(); i += 3) {
                const Vec3f v = developed(how, full, {float(in[i]), float(in[i + 1]), float(in[i + 2])});
                out[i] = v.x, out[i + 1] = v.y, out[i + 2] = v.z;
            }
        });
}

}  // namespace

HighlightRule highlights_of(std::string_view name) {
    if (name == "clip") return HighlightRule::clip;
    if (name == "blend") return HighlightRule::blend;
    if (name == "reconstruct") return HighlightRule::reconstruct;
    throw input_error("develop", "highlights", "clip, blend or reconstruct", std::string(name));
}

Vec3f into_gamut(const Vec3f& rgb, const Vec3f& luminance) {
    const float low = smallest(rgb);
    if (low >= 0) return rgb;
    const float y = dot(luminance, rgb);
    if (!(y > 0)) return {0, 0, 0};
    const Vec3f in = from_neutral(rgb, y, y / (y - low));
    return {std::max(in.x, 0.0f), std::max(in.y, 0.0f), std::max(in.z, 0.0f)};
}

Vec3f below_white(const Vec3f& rgb) {
    const float high = max_component(rgb);
    if (high <= 1) return rgb;
    const float white = (high - 1) / (high - 1 + kHalfWhite);
    return capped(from_neutral(rgb / high, 1, 1 - white), 1);
}

void develop(const Development& how, std::span<const std::uint16_t> in, std::span<float> out) {
    develop_all(how, in, out);
}

void develop(const Development& how, std::span<const float> in, std::span<float> out) {
    develop_all(how, in, out);
}

}  // namespace dg
