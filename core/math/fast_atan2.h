// fast_atan2.h -- atan2 in float, for look-ups in tables; same bits on all machines.
#pragma once
#include <algorithm>
#include <cmath>

namespace dg {

/// atan2 with an absolute error below 4e-7 rad; 0 for (0, 0). Source: Abramowitz and Stegun 1964, Handbook of
/// Mathematical Functions, 4.4.49 (error of the polynomial below 2e-8).
inline float fast_atan2(float y, float x) {
    constexpr float kHalfPi = 1.57079633f, kPi = 3.14159265f;
    const float across = std::abs(x), up = std::abs(y);
    const float large = std::max(across, up);
    if (!(large > 0)) return 0;
    const float t = std::min(across, up) / large;
    const float z = t * t, z2 = z * z, z4 = z2 * z2;
    const float low = (1 - 0.3333314528f * z) + (0.1999355085f - 0.1420889944f * z) * z2;
    const float high = (0.1065626393f - 0.0752896400f * z) + (0.0429096138f - 0.0161657367f * z) * z2;
    float angle = t * (low + (high + 0.0028662257f * z4) * z4);
    if (up > across) angle = kHalfPi - angle;
    if (x < 0) angle = kPi - angle;
    return std::copysign(angle, y);
}

}  // namespace dg
