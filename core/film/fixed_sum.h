// fixed_sum.h -- sums that do not depend on the order of their terms: 128-bit fixed
// point.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace dg {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

/// A sum in steps of 2^-kFractionBits. Each term is rounded toward 0 to whole steps, then
/// added as an integer: exact, associative and commutative. A float of
/// magnitude 2^(24 - kFractionBits) or more is a whole number of steps already. Range of
/// the sum: +-2^(127 - kFractionBits).
template <int kFractionBits>
class FixedSum {
  public:
    /// The caller checks that |v| < 2^(126 - kFractionBits), and not NaN. Integer part and
    /// remainder of the scaled double are exact; the remainder keeps 63 bits.
    void add(double v) {
        const double scaled = v * kScale;
        const double whole = std::trunc(scaled);
        const auto high = std::int64_t(whole);
        const auto low = std::int64_t((scaled - whole) * 0x1p63);
        add_bits((Int128(high) << 63) + low);
    }
    void add(const FixedSum& other) { add_bits(other.bits_); }
    /// Adds whole steps of 2^-kFractionBits.
    void add_steps(Int128 steps) { add_bits(steps); }
    static constexpr int kBits = kFractionBits;

    std::span<const FixedSum> values() const { return {this, 1}; }
    /// Nearest double.
    double value() const { return double(bits_) * (1.0 / double(1ull << kFractionBits)); }
    friend bool operator==(const FixedSum& a, const FixedSum& b) = default;

  private:
    static constexpr double kScale =
        kFractionBits <= 63 ? 1.0 / double(1ull << (63 - kFractionBits)) : 0;
    static_assert(kFractionBits > 0 && kFractionBits <= 63);

    /// Unsigned, as sums out of a damaged file may overflow: they wrap around.
    void add_bits(Int128 bits) { bits_ = Int128(UInt128(bits_) + UInt128(bits)); }

    Int128 bits_ = 0;
};

/// Sums of values: steps of 1.1e-19, up to 1.8e19.
using ValueSum = FixedSum<63>;
/// Sums of squares: steps of 1.1e-13, up to 1.9e25.
using SquareSum = FixedSum<43>;

/// Largest value of a good sample; sums of 2^24 such samples fit.
inline constexpr float kMaxFilmValue = 0x1p40f;
inline bool fits_film(float v) {
    return std::abs(v) <= kMaxFilmValue;
}
/// Limit that squares are clamped to (values above 3e9): the variance with such fireflies is
/// a lower bound.
inline constexpr double kMaxFilmSquare = 0x1p63;

}  // namespace dg
