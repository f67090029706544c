#include "develop/curve.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr int kFractionBits = 23 - Curve::kOctaveBits;   // of a float, below those that choose the place
constexpr std::size_t kCount = (Curve::kHighest - Curve::kLowest) * Curve::kPerOctave + 2;
const std::uint32_t kFirst = std::bit_cast<std::uint32_t>(std::ldexp(1.0f, Curve::kLowest)) >> kFractionBits;

}  // namespace

std::vector<float> Curve::breakpoints() {
    std::vector<float> out{0};
    for (std::uint32_t i = 0; i + 1 < kCount; ++i)
        out.push_back(std::bit_cast<float>((kFirst + i) << kFractionBits));
    return out;
}

Curve::Curve(std::vector<float> values) : values_(std::move(values)) {
    if (values_.size() != kCount)
        throw input_error("curve", "values", std::to_string(kCount), std::to_string(values_.size()));
    values_.push_back(values_.back());   // the last breakpoint is the start of a level piece
}

float Curve::operator()(float x) const {
    static const float lowest = std::ldexp(1.0f, kLowest), highest = std::ldexp(1.0f, kHighest);
    if (!(x > 0)) return values_[0];
    if (x < lowest) return values_[0] + (values_[1] - values_[0]) * (x / lowest);
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x < highest ? x : highest);
    const std::uint32_t i = (bits >> kFractionBits) - kFirst + 1;
    const float t = float(bits & ((1u << kFractionBits) - 1)) * std::ldexp(1.0f, -kFractionBits);
    return values_[i] + (values_[i + 1] - values_[i]) * t;
}

}  // namespace dg
