// curve.h -- tabulated curve over the whole range of exposures.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

namespace dg {

/// Smooth curve of light x >= 0, piecewise linear with breakpoints at 0 and kPerOctave per octave
/// from kLowest to kHighest. Steps grow with x, so the relative precision is constant, and the
/// table index comes from a float's bits.
class Curve {
  public:
    static constexpr int kOctaveBits = 6, kPerOctave = 1 << kOctaveBits;
    static constexpr float kLowest = 0x1p-20f, kHighest = 0x1p12f;

    /// Ascending positions at which the curve is tabulated.
    static std::vector<float> breakpoints();

    /// `values` at the breakpoints.
    explicit Curve(std::vector<float> values);

    /// NaN and negative light count as 0; the curve is constant above the last breakpoint.
    float operator()(float x) const {
        const float* const values = values_.data();
        if (!(x >= kLowest)) return x > 0 ? values[0] + (values[1] - values[0]) * (x / kLowest) : values[0];
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(x < kHighest ? x : kHighest);
        const std::uint32_t i = (bits >> kFractionBits) - kFirst + 1;
        const float t = float(bits & ((1u << kFractionBits) - 1)) * kFraction;
        return values[i] + (values[i + 1] - values[i]) * t;
    }

  private:
    static constexpr int kFractionBits = 23 - kOctaveBits;   // mantissa bits below the table index
    static constexpr float kFraction = 1.0f / (1 << kFractionBits);
    static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(kLowest) >> kFractionBits;
    static constexpr std::uint32_t kLast = std::bit_cast<std::uint32_t>(kHighest) >> kFractionBits;

    std::vector<float> values_;
};

}  // namespace dg
