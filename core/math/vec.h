// vec.h -- small vectors: aggregates with component-wise operators.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/portable.h"

namespace dg {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr double kPiD = std::numbers::pi;

template <typename T>
struct Vec2 {
    T x{}, y{};
    friend Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec2 operator*(Vec2 a, T s) { return {a.x * s, a.y * s}; }
    friend Vec2 operator*(T s, Vec2 a) { return a * s; }
    friend bool operator==(Vec2 a, Vec2 b) = default;
};

template <typename T>
T dot(Vec2<T> a, Vec2<T> b) { return a.x * b.x + a.y * b.y; }
template <typename T>
T length_squared(Vec2<T> a) { return dot(a, a); }
template <typename T>
T length(Vec2<T> a) { return std::sqrt(dot(a, a)); }

template <typename T>
struct Vec3 {
    T x{}, y{}, z{};
    T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
    friend Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
    friend Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend Vec3 operator*(T s, Vec3 a) { return a * s; }
    friend Vec3 operator/(Vec3 a, T s) { return a * (T(1) / s); }
    Vec3& operator+=(Vec3 b) { return *this = *this + b; }
    Vec3& operator*=(T s) { return *this = *this * s; }
    friend bool operator==(Vec3 a, Vec3 b) = default;
};

template <typename T>
T dot(Vec3<T> a, Vec3<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <typename T>
Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T length_squared(Vec3<T> a) { return dot(a, a); }
template <typename T>
T length(Vec3<T> a) { return std::sqrt(dot(a, a)); }
template <typename T>
Vec3<T> normalize(Vec3<T> a) { return a * (T(1) / length(a)); }
template <typename T>
T max_component(Vec3<T> a) { return std::max(a.x, std::max(a.y, a.z)); }
/// Scale of rounding errors in ray tracing.
template <typename T>
T largest_coordinate(Vec3<T> a) { return max_component(Vec3<T>{std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

/// Limit of coordinates and transform entries, m: squares of larger numbers overflow float. Checked
/// for scenes when they are built (same number in Python's scene/limits.py), and for rays when they
/// are traced.
inline constexpr float kFar = 1e18f;
/// False for NaN.
template <typename T>
bool within_limits(Vec3<T> a) {
    return std::abs(a.x) < T(kFar) && std::abs(a.y) < T(kFar) && std::abs(a.z) < T(kFar);
}

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec2d = Vec2<double>;
using Vec3d = Vec3<double>;

inline Vec3f to_float(Vec3d a) { return {float(a.x), float(a.y), float(a.z)}; }
inline Vec3d to_double(Vec3f a) { return {a.x, a.y, a.z}; }

/// Right-handed orthonormal basis with local z along the unit vector n. Source: Duff et al. 2017,
/// Building an Orthonormal Basis, Revisited, JCGT 6(1).
struct Frame {
    Vec3f x, y, z;
    static Frame from_normal(Vec3f n) {
        const float sign = std::copysign(1.f, n.z);
        const float a = -1.f / (sign + n.z);
        const float b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x},
                {b, sign + n.y * n.y * a, -n.y},
                n};
    }
    Vec3f to_local(Vec3f v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3f to_world(Vec3f v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace dg
