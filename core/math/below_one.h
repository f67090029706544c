// below_one.h -- largest float below 1: the upper clamp for random numbers in [0, 1) that rounding
// may take to 1.
#pragma once

namespace dg {

constexpr float kBelowOne = 0x1.fffffep-1f;

}  // namespace dg
