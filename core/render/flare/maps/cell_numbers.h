// cell_numbers.h -- random numbers of the arrivals of one cell: points that are evenly spread over all of their dimensions,
// whatever part of them is drawn.
#pragma once
#include <algorithm>
#include <cstdint>

#include "math/sobol.h"

namespace dg {

/// Sobol points, Owen-scrambled (math/sobol.h), many at a time.
class CellNumbers {
  public:
    static constexpr int kMost = 256, kMostLanes = 64;
    enum Dimension { kAcross, kDown, kPoint, kLambda, kLevel, kDimensions };
    float of[kDimensions][kMost + kMostLanes];

    /// Fills `of` with points [first, last), or the first of them; returns how many. `seed`: of the cell.
    int fill(std::uint64_t seed, std::uint64_t first, std::uint64_t last);
    /// Calls draw(first, count) with `of` filled, until all of [first, last) were there.
    template <typename Draw>
    void each(std::uint64_t seed, std::uint64_t first, std::uint64_t last, const Draw& draw) {
        for (int count; first < last; first += std::uint64_t(count)) count = fill(seed, first, last), draw(first, count);
    }
};

}  // namespace dg
