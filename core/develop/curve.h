// curve.h -- a curve of light as a table, over all stops that pictures have.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

namespace dg {

/// A smooth curve of light x >= 0, straight between breakpoints: 0, and kPerOctave in each octave from
/// kLowest to kHighest. Steps grow with x, so that shadows are as exact as highlights, and the place in
/// the table is read off a float's bits.
class Curve {
  public:
    static constexpr int kOctaveBits = 6, kPerOctave = 1 << kOctaveBits;
    static constexpr float kLowest = 0x1p-20f, kHighest = 0x1p12f;

    /// Where the curve has to be known, rising.
    static std::vector<float> breakpoints();

    /// `values` at the breakpoints.
    explicit Curve(std::vector<float> values);

    /// NaN and negative light count as none; above the last breakpoint the curve is level.
    float operator()(float x) const {
        const float* const values = values_.data();
        if (!(x >= kLowest)) return x > 0 ? values[0] + (values[1] - values[0]) * (x / kLowest) : values[0];
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(x < kHighest ? x : kHighest);
        const std::uint32_t i = (bits >> kFractionBits) - kFirst + 1;
        const float t = float(bits & ((1u << kFractionBits) - 1)) * kFraction;
        return values[i] + (values[i + 1] - values[i]) * t;
    }

  private:
    static constexpr int kFractionBits = 23 - kOctaveBits;   // of a float, below those that choose the place
    static constexpr float kFraction = 1.0f / (1 << kFractionBits);
    static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(kLowest) >> kFractionBits;
    static constexpr std::uint32_t kLast = std::bit_cast<std::uint32_t>(kHighest) >> kFractionBits;

    std::vector<float> values_;
};

}  // namespace dg
