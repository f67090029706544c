// fresnel_conductor.h -- Fresnel reflectance of a metal.
#pragma once
#include <cmath>

#include "spectrum/spectrum.h"

namespace dg {

/// Unpolarised reflectance at the cosine cos_i, from a clear medium to a medium of relative index eta + i k. With
/// n^2 - k^2 - sin^2 = p and sqrt(p^2 + 4 n^2 k^2) = a^2 + b^2, where a + i b is the normal component of the refracted
/// wave vector:
///   R_s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2),
///   R_p = R_s (c^2 (a^2 + b^2) - 2 a c s^2 + s^4) / (c^2 (a^2 + b^2) + 2 a c s^2 + s^4).
/// Source: Born and Wolf, Principles of Optics, 14.2 (7th edition).
inline Spectrum fresnel_conductor(float cos_i, Spectrum eta, Spectrum k) {
    const float c = std::clamp(cos_i, 0.f, 1.f), c2 = c * c, s2 = 1 - c2;
    const Spectrum p = eta * eta - k * k - s2;
    const Spectrum a2b2 = sqrt(p * p + eta * eta * k * k * 4);
    const Spectrum half = (a2b2 + p) * 0.5f;
    const Spectrum a{std::sqrt(std::max(half[0], 0.f)), std::sqrt(std::max(half[1], 0.f)),
                     std::sqrt(std::max(half[2], 0.f)), std::sqrt(std::max(half[3], 0.f))};
    const Spectrum sum = a2b2 + c2, cross = a * (2 * c);
    const Spectrum rs = (sum - cross) / (sum + cross);
    const Spectrum even = a2b2 * c2 + s2 * s2, odd = cross * s2;
    const Spectrum both = rs * (even - odd) / (even + odd);
    return (rs + both) * 0.5f;
}

}  // namespace dg
