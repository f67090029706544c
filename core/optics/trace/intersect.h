// intersect.h -- intersection of a ray with a surface in the surface's frame, and refraction.
// Templates on the scalar: double, or Dual for derivatives.
//
// The ray crosses the surface in the direction of travel: `sign` is +1 toward +z, -1 toward -z.
// Crossings in the opposite sense (out of the back of a ball) are ignored.
#pragma once
#include <optional>

#include "optics/lens/form.h"

namespace dg {

template <typename T>
struct LensHit {
    Vec3<T> point, normal;  // normal: unit vector toward +z
    T cosine;               // of incidence, positive
};

/// Ray parameter of the first crossing, in the direction of travel, with a surface that is no
/// quadric: |sag - z| < 1e-9 mm there. The ray's origin must be its point nearest to the vertex.
/// Finds every sign change within the clear radius; the number of iterations is bounded.
std::optional<double> first_crossing(const SurfaceForm& form, const Vec3d& origin,
                                     const Vec3d& direction, int sign);

// Feder's curvature form, extended by a conic constant and, for cylinders, by weights that drop one
// axis: the same arithmetic for planes and curved surfaces. With the ray m + t d from its point
// nearest to the vertex, A t^2 - 2 B t + C = 0. Source: Feder 1951, Optical Calculations with
// Automatic Computing Machinery, JOSA 41(9), eqs. 1-9; also valid for rays at and beyond 90
// degrees.
template <typename T>
std::optional<LensHit<T>> meet_quadric(const SurfaceForm& f, const Vec3<T>& m,
                                       const Vec3<T>& d, int sign) {
    using std::sqrt;
    const double c = f.c, wz = 1 + f.k;
    const T cc = c * (f.wx * m.x * m.x + f.wy * m.y * m.y + wz * m.z * m.z) - 2.0 * m.z;
    const T a = c * (f.wx * d.x * d.x + f.wy * d.y * d.y + wz * d.z * d.z);
    const T b = d.z - c * (f.wx * m.x * d.x + f.wy * m.y * d.y + wz * m.z * d.z);
    const T discriminant = b * b - a * cc;
    if (!(value_of(discriminant) >= 0)) return std::nullopt;  // missed
    const T root = sqrt(discriminant) * double(sign);
    const T t = sign * value_of(b) >= 0 ? cc / (b + root) : (b - root) / a;
    LensHit<T> hit;
    hit.point = m + t * d;
    const T toward_axis = T(1) - c * wz * hit.point.z;
    if (!(value_of(toward_axis) > 0)) return std::nullopt;  // far half of the quadric
    hit.normal = {(-c * f.wx) * hit.point.x, (-c * f.wy) * hit.point.y, toward_axis};
    hit.cosine = root * double(sign);
    if (!f.sphere) {
        const T inverse = T(1) / sqrt(dot(hit.normal, hit.normal));
        hit.normal = inverse * hit.normal;
        hit.cosine = hit.cosine * inverse;
    }
    return hit;
}

/// Intersection with a searched surface. One Newton step on dual numbers from the root gives the
/// derivatives of the crossing.
template <typename T>
std::optional<LensHit<T>> meet_sag(const SurfaceForm& f, const Vec3<T>& m,
                                   const Vec3<T>& d, int sign) {
    using std::sqrt;
    const Vec3d start{value_of(m.x), value_of(m.y), value_of(m.z)};
    const Vec3d along{value_of(d.x), value_of(d.y), value_of(d.z)};
    const auto found = first_crossing(f, start, along, sign);
    if (!found) return std::nullopt;
    T t = T(*found);
    for (int step = newton_steps(m.x); step > 0; --step) {
        const Vec3<T> near = m + t * d;
        const Sag<T> there = sag(f, near.x, near.y);
        const T speed = d.z - there.slope_x * d.x - there.slope_y * d.y;
        const T gap = near.z - there.z;
        t = t - (gap - T(value_of(gap))) / speed;
    }
    LensHit<T> hit;
    hit.point = m + t * d;
    const Sag<T> s = sag(f, hit.point.x, hit.point.y);
    const T inverse = T(1) / sqrt(T(1) + s.slope_x * s.slope_x + s.slope_y * s.slope_y);
    hit.normal = {-s.slope_x * inverse, -s.slope_y * inverse, inverse};
    hit.cosine = double(sign) * dot(d, hit.normal);
    if (!(value_of(hit.cosine) > 0)) return std::nullopt;
    return hit;
}

/// Intersects a ray in the surface's frame.
template <typename T>
std::optional<LensHit<T>> meet(const SurfaceForm& f, const Vec3<T>& origin,
                               const Vec3<T>& direction, int sign) {
    const Vec3<T> m = origin - dot(origin, direction) * direction;
    return f.quadric ? meet_quadric(f, m, direction, sign)
                     : meet_sag(f, m, direction, sign);
}

/// Snell's law for n1 / n2 = mu; empty after total reflection. `cosine` returns the cosine of the
/// refracted ray.
template <typename T>
std::optional<Vec3<T>> refract(const Vec3<T>& direction, const LensHit<T>& hit, int sign,
                               double mu, T& cosine) {
    using std::sqrt;
    const T squared = T(1) - (mu * mu) * (T(1) - hit.cosine * hit.cosine);
    if (!(value_of(squared) >= 0)) return std::nullopt;
    cosine = sqrt(squared);
    return T(mu) * direction + (double(sign) * (cosine - mu * hit.cosine)) * hit.normal;
}

}  // namespace dg
