// spread_numbers.h -- a four-dimensional low-discrepancy sequence; any range of it is well distributed.
#pragma once
#include <cstdint>

namespace dg {

/// The generalised golden ratio (Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences).
struct SpreadNumbers {
    std::uint32_t i;
    /// Coordinate k of the point, in [0, 1).
    float operator[](int k) const {
        constexpr std::uint32_t kStep[4] = {3679390609u, 3152041523u, 2700274806u, 2313257605u};
        return float((i * kStep[k]) >> 8) * 0x1p-24f;
    }
};

}  // namespace dg
