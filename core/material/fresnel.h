// fresnel.h -- reflectance of a dielectric interface, exact and by Schlick's approximation.
#pragma once
#include <algorithm>
#include <cmath>

namespace dg {

/// (1 - c)^5, the shape of F = F0 + (F90 - F0) (1 - c)^5. Source: Schlick 1994, An
/// Inexpensive BRDF Model for Physically-based Rendering.
inline float schlick(float cos_angle) {
    const float m = std::clamp(1.f - cos_angle, 0.f, 1.f), m2 = m * m;
    return m2 * m2 * m;
}

/// Reflectance at normal incidence of an interface of relative index `ior`.
inline float normal_reflectance(float ior) {
    const float r = (ior - 1) / (ior + 1);
    return r * r;
}

/// Unpolarised reflectance of a clear dielectric; eta = index beyond / index here, cos_i
/// > 0 here. 1 in total internal reflection. Source: Fresnel's equations, Born and
/// Wolf, 1.5.2.
inline float fresnel_dielectric(float cos_i, float eta) {
    const float cos2_t = 1 - (1 - cos_i * cos_i) / (eta * eta);
    if (cos2_t <= 0) return 1;
    const float cos_t = std::sqrt(cos2_t);
    const float s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const float p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return std::min(1.f, 0.5f * (s * s + p * p));
}

}  // namespace dg
