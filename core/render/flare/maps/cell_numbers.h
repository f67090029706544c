// cell_numbers.h -- low-discrepancy points for the arrivals of a cell; any range of them is well distributed.
#pragma once
#include <algorithm>
#include <cstdint>

#include "math/sobol.h"

namespace dg {

/// Owen-scrambled Sobol points (math/sobol.h), in batches.
class CellNumbers {
  public:
    static constexpr int kMost = 256, kMostLanes = 64;
    enum Dimension { kAcross, kDown, kPoint, kLambda, kLevel, kDimensions };
    float of[kDimensions][kMost + kMostLanes];

    /// Fills `of` with as many points of [first, last) as fit, and returns their number. `seed`: of the cell.
    int fill(std::uint64_t seed, std::uint64_t first, std::uint64_t last);
    /// Fills `of` with batches of [first, last) and calls draw(first, count) for each.
    template <typename Draw>
    void each(std::uint64_t seed, std::uint64_t first, std::uint64_t last, const Draw& draw) {
        for (int count; first < last; first += std::uint64_t(count)) count = fill(seed, first, last), draw(first, count);
    }
};

}  // namespace dg
