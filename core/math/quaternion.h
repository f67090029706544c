// quaternion.h -- rotations as unit quaternions, in glTF's order x, y, z, w.
#pragma once
#include <cmath>

#include "math/transform.h"
#include "math/vec.h"

namespace dg {

template <typename T>
struct Quaternion {
    T x{}, y{}, z{}, w{1};

    /// Rotation by `angle` rad about a unit axis, right-handed.
    static Quaternion from_axis_angle(Vec3<T> axis, T angle) {
        const T s = std::sin(angle / 2);
        return {axis.x * s, axis.y * s, axis.z * s, std::cos(angle / 2)};
    }

    friend Quaternion operator+(Quaternion a, Quaternion b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
    }
    friend Quaternion operator-(Quaternion a) { return {-a.x, -a.y, -a.z, -a.w}; }
    friend Quaternion operator*(Quaternion a, T s) {
        return {a.x * s, a.y * s, a.z * s, a.w * s};
    }
    /// Hamilton product: rotation b followed by a.
    friend Quaternion operator*(Quaternion a, Quaternion b) {
        return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
                a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
                a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    }
    Quaternion conjugate() const { return {-x, -y, -z, w}; }
    Vec3<T> rotate(Vec3<T> v) const {
        const Vec3<T> q{x, y, z}, t = cross(q, v) * T(2);
        return v + t * w + cross(q, t);
    }
};

template <typename T>
T dot(Quaternion<T> a, Quaternion<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
template <typename T>
Quaternion<T> normalize(Quaternion<T> q) {
    return q * (T(1) / std::sqrt(dot(q, q)));
}

/// Constant-speed interpolation along the shorter arc; a and b are unit, t in [0,1]. The angle
/// comes from atan2 of chord lengths, which is accurate where acos(dot) loses digits. Source:
/// Shoemake 1985, Animating Rotation with Quaternion Curves, SIGGRAPH.
template <typename T>
Quaternion<T> slerp(Quaternion<T> a, Quaternion<T> b, T t) {
    if (dot(a, b) < 0) b = -b;
    const Quaternion<T> difference = b + -a, sum = a + b;
    const T angle =
        2 * atan2(std::sqrt(dot(difference, difference)), std::sqrt(dot(sum, sum)));
    if (angle < T(1e-4)) return normalize(a * (1 - t) + b * t);
    const T s = std::sin(angle);
    return normalize(a * (std::sin((1 - t) * angle) / s) + b * (std::sin(t * angle) / s));
}

/// Rotation matrix of a unit quaternion (origin 0).
template <typename T>
Affine<T> to_matrix(Quaternion<T> q) {
    return {q.rotate({1, 0, 0}), q.rotate({0, 1, 0}), q.rotate({0, 0, 1}), {}};
}

/// Unit quaternion of a rotation matrix (orthonormal columns, determinant +1), with w >= 0. Starts
/// from the largest component to avoid cancellation. Source: Shepperd 1978, Quaternion from
/// Rotation Matrix, J. Guidance and Control 1(3).
template <typename T>
Quaternion<T> from_matrix(const Affine<T>& m) {
    const T trace = m.x.x + m.y.y + m.z.z;
    Quaternion<T> q;
    if (trace >= std::max({m.x.x, m.y.y, m.z.z}))
        q = {m.y.z - m.z.y, m.z.x - m.x.z, m.x.y - m.y.x, 1 + trace};
    else if (m.x.x >= std::max(m.y.y, m.z.z))
        q = {1 + m.x.x - m.y.y - m.z.z, m.x.y + m.y.x, m.x.z + m.z.x, m.y.z - m.z.y};
    else if (m.y.y >= m.z.z)
        q = {m.x.y + m.y.x, 1 + m.y.y - m.x.x - m.z.z, m.y.z + m.z.y, m.z.x - m.x.z};
    else
        q = {m.x.z + m.z.x, m.y.z + m.z.y, 1 + m.z.z - m.x.x - m.y.y, m.x.y - m.y.x};
    q = normalize(q);
    return q.w < 0 ? -q : q;
}

using Quaternionf = Quaternion<float>;
using Quaterniond = Quaternion<double>;

}  // namespace dg
