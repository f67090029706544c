// warp.h -- maps from the unit square to discs, triangles and directions, with their densities. All
// are nearly continuous, so that stratified points stay stratified.
#pragma once
#include "math/vec.h"

namespace dg {

/// Uniform on the unit disc. Source: Shirley and Chiu 1997, A Low Distortion Map Between Disk and
/// Square.
inline Vec2f warp_disk(Vec2f u) {
    const float a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool wide = std::abs(a) > std::abs(b);
    const float r = wide ? a : b;
    const float angle = wide ? (kPi / 4) * (b / a) : (kPi / 2) - (kPi / 4) * (a / b);
    return {r * std::cos(angle), r * std::sin(angle)};
}
inline float warp_disk_pdf(Vec2f p) {
    return length_squared(p) <= 1 ? 1 / kPi : 0;
}

/// Barycentric weights of the second and third corner, uniform, with density 2 (1 / area on the
/// triangle). Source: Heitz 2019, A Low-Distortion Map Between Triangle and Square.
inline Vec2f warp_triangle(Vec2f u) {
    if (u.y > u.x) {
        const float x = u.x * 0.5f;
        return {x, u.y - x};
    }
    const float y = u.y * 0.5f;
    return {u.x - y, y};
}
inline float warp_triangle_pdf(Vec2f b) {
    return b.x >= 0 && b.y >= 0 && b.x + b.y <= 1 ? 2.f : 0.f;
}

/// Cosine-weighted directions around +z, density cos / pi (Malley's method).
inline Vec3f warp_cosine_hemisphere(Vec2f u) {
    const Vec2f d = warp_disk(u);
    return {d.x, d.y, std::sqrt(std::max(0.f, 1 - length_squared(d)))};
}
inline float warp_cosine_hemisphere_pdf(Vec3f w) {
    return std::max(0.f, w.z) / kPi;
}

/// Uniform directions. z decreases from 1 to -1 with u.x.
inline Vec3f warp_sphere(Vec2f u) {
    const float z = 1 - 2 * u.x;
    const float r = 2 * std::sqrt(std::max(0.f, u.x * (1 - u.x)));
    const float phi = 2 * kPi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}
inline float warp_sphere_pdf() {
    return 1 / (4 * kPi);
}

/// Uniform directions in a cone around +z, given by 1 - cos of its half angle: cos alone loses
/// precision for narrow cones.
inline Vec3f warp_cone(Vec2f u, float one_minus_cos) {
    const float h = u.x * one_minus_cos;  // 1 - cos theta
    const float r = std::sqrt(std::max(0.f, h * (2 - h)));
    const float phi = 2 * kPi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), 1 - h};
}
inline float warp_cone_pdf(float one_minus_cos) {
    return 1 / (2 * kPi * one_minus_cos);
}
/// 1 - cos theta from sin^2 theta, theta <= 90 degrees, without cancellation.
inline float one_minus_cos_from_sin2(float sin2) {
    return sin2 / (1 + std::sqrt(std::max(0.f, 1 - sin2)));
}

}  // namespace dg
