// curve.h -- a curve of light as a table, over all stops that pictures have.
#pragma once
#include <vector>

namespace dg {

/// A smooth curve of light x >= 0, straight between breakpoints: 0, and kPerOctave in each octave from
/// 2^kLowest to 2^kHighest. Steps grow with x, so that shadows are as exact as highlights, and the place in
/// the table is read off a float's bits.
class Curve {
  public:
    static constexpr int kLowest = -20, kHighest = 12, kOctaveBits = 6, kPerOctave = 1 << kOctaveBits;

    /// Where the curve has to be known, rising.
    static std::vector<float> breakpoints();

    /// `values` at the breakpoints.
    explicit Curve(std::vector<float> values);

    /// NaN and negative light count as none; above the last breakpoint the curve is level.
    float operator()(float x) const;

  private:
    std::vector<float> values_;
};

}  // namespace dg
