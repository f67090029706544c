// below_one.h -- the largest float below 1, where random numbers in [0, 1) end that rounding may take to 1.
#pragma once

namespace dg {

constexpr float kBelowOne = 0x1.fffffep-1f;

}  // namespace dg
