// transform.h -- affine transforms on column vectors: world = matrix * local.
#pragma once
#include <array>

#include "math/vec.h"

namespace dg {

template <typename T>
struct Affine {
    // Columns of the linear part, and translation.
    Vec3<T> x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

    Vec3<T> point(Vec3<T> p) const { return x * p.x + y * p.y + z * p.z + origin; }
    Vec3<T> vector(Vec3<T> v) const { return x * v.x + y * v.y + z * v.z; }
    T determinant() const { return dot(x, cross(y, z)); }

    /// Normals transform by the cofactor matrix. The result is not normalized; it stays on the same
    /// side of the surface for mirroring transforms too.
    Vec3<T> normal(Vec3<T> n) const {
        const Vec3<T> m = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
        return determinant() < 0 ? -m : m;
    }

    friend Affine operator*(const Affine& a, const Affine& b) {
        return {a.vector(b.x), a.vector(b.y), a.vector(b.z), a.point(b.origin)};
    }
};

/// Inverse; the determinant must not be 0.
template <typename T>
Affine<T> inverse(const Affine<T>& a) {
    const T s = T(1) / a.determinant();
    const Vec3<T> r0 = cross(a.y, a.z) * s, r1 = cross(a.z, a.x) * s, r2 = cross(a.x, a.y) * s;
    Affine<T> r{{r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z}, {}};
    r.origin = -r.vector(a.origin);
    return r;
}

/// Whether rays can be transformed in single precision: the volume of the transformed unit cube is
/// more than 1e-7 (the precision of float) of the product of its edges.
inline bool is_invertible(const Affine<double>& a) {
    constexpr double kSmallest = 1e-7;
    const double edges = length_squared(a.x) * length_squared(a.y) * length_squared(a.z);
    const double volume = a.determinant();
    return edges > 1e-120 && volume * volume > kSmallest * kSmallest * edges;
}

inline Affine<double> to_double(const Affine<float>& a) {
    return {to_double(a.x), to_double(a.y), to_double(a.z), to_double(a.origin)};
}
inline Affine<float> to_float(const Affine<double>& a) {
    return {to_float(a.x), to_float(a.y), to_float(a.z), to_float(a.origin)};
}

using Affine3f = Affine<float>;
using Affine3d = Affine<double>;

}  // namespace dg
