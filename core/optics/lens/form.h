// form.h -- a surface prepared for tracing: its sag function and its frame.
#pragma once
#include <cmath>
#include <vector>

#include "math/dual.h"
#include "optics/lens/surface.h"

namespace dg {

/// Local frame of a surface in the lens frame; local z is the surface's axis.
struct SurfaceFrame {
    Vec3d origin{};  // vertex, mm
    bool turned = false;
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // local axes in the lens frame

    template <typename T>
    Vec3<T> turn_in(const Vec3<T>& v) const {
        if (!turned) return v;
        return {x.x * v.x + x.y * v.y + x.z * v.z, y.x * v.x + y.y * v.y + y.z * v.z,
                z.x * v.x + z.y * v.y + z.z * v.z};
    }
    template <typename T>
    Vec3<T> turn_out(const Vec3<T>& v) const {
        if (!turned) return v;
        return {x.x * v.x + y.x * v.y + z.x * v.z, x.y * v.x + y.y * v.y + z.y * v.z,
                x.z * v.x + y.z * v.y + z.z * v.z};
    }
    template <typename T>
    Vec3<T> into(const Vec3<T>& p) const {
        return turn_in(p - Vec3<T>{origin.x, origin.y, origin.z});
    }
    template <typename T>
    Vec3<T> out_of(const Vec3<T>& p) const {
        return turn_out(p) + Vec3<T>{origin.x, origin.y, origin.z};
    }
};

/// Sag and slopes at a point. Outside the domain (where the root of the base form has a negative
/// argument) `defined` is false, and z continues smoothly to guide root finding.
template <typename T>
struct Sag {
    T z, slope_x, slope_y;
    bool defined = true;
};

struct SurfaceForm {
    Shape shape = Shape::conic;
    double cx = 0, cy = 0, kx = 0, ky = 0;  // curvature and conic constant of both sections
    /// Coefficients of the asphere: sum even[j] r^(2j+2) + sum odd[j] r^(2j+1).
    std::vector<double> even, odd;
    /// `quadric`: the surface is c (wx x^2 + wy y^2 + (1+k) z^2) = 2 z and is intersected in closed
    /// form (conics, cylinders and planes without an asphere).
    bool quadric = false, sphere = false;
    double c = 0, k = 0, wx = 1, wy = 1;
    /// Clear radius, and bounds of |sag| and slope within it; an infinite bound means unknown.
    double clear = 0, height = 0, slope = 0;
    SurfaceFrame place;
    RippleSlope ripple;

    SurfaceForm(const Surface& surface, double vertex_z);
};

namespace form_detail {

constexpr double kEdge = 1e-6;  // least 1 - (1+k) c^2 r^2 at which a sag counts as defined

/// sqrt(v), continued below kEdge by a smooth positive function with the tangent's slope.
template <typename T>
T domed_root(const T& v, bool& defined) {
    using std::sqrt;
    if (value_of(v) >= kEdge) return sqrt(v);
    defined = false;
    return std::sqrt(kEdge) / (T(1) + (T(kEdge) - v) * (0.5 / kEdge));
}

template <typename T>
Sag<T> conic(double c, double k, const T& x, const T& y) {
    Sag<T> s;
    const T r2 = x * x + y * y;
    const T root = domed_root(T(1) - (1 + k) * c * c * r2, s.defined);
    const T slope = T(c) / root;
    s.z = c * r2 / (T(1) + root), s.slope_x = slope * x, s.slope_y = slope * y;
    return s;
}

// Biconic sag: z = Q / (1 + sqrt(1 - P)) with Q = cx x^2 + cy y^2, P = (1+kx) cx^2 x^2 + ...
template <typename T>
Sag<T> biconic(const SurfaceForm& f, const T& x, const T& y) {
    Sag<T> s;
    const double px = (1 + f.kx) * f.cx * f.cx, py = (1 + f.ky) * f.cy * f.cy;
    const T root = domed_root(T(1) - px * x * x - py * y * y, s.defined);
    const T inverse = T(1) / (T(1) + root);
    s.z = (f.cx * x * x + f.cy * y * y) * inverse;
    const T bend = s.z * inverse / root;
    s.slope_x = x * (2 * f.cx * inverse + px * bend);
    s.slope_y = y * (2 * f.cy * inverse + py * bend);
    return s;
}

// Toroid sag: the section g(y) is revolved about an axis parallel to y at z = 1/cx: (1/cx - z)^2 +
// x^2 = (1/cx - g)^2, or z = H / (1 + sqrt(1 - cx H)) with H = 2g - cx g^2 + cx x^2.
template <typename T>
Sag<T> toroid(const SurfaceForm& f, const T& x, const T& y) {
    const Sag<T> g = conic(f.cy, f.ky, T(0), y);
    Sag<T> s;
    s.defined = g.defined;
    const T h = 2.0 * g.z - f.cx * g.z * g.z + f.cx * x * x;
    const T root = domed_root(T(1) - f.cx * h, s.defined);
    s.z = h / (T(1) + root);
    s.slope_x = f.cx * x / root;
    s.slope_y = g.slope_y * (T(1) - f.cx * g.z) / root;
    return s;
}

template <typename T>
void add_asphere(const SurfaceForm& f, const T& x, const T& y, Sag<T>& s) {
    using std::sqrt;
    const T u = x * x + y * y;
    T sum = 0, slope = 0;  // even terms, and their derivative by u
    for (std::size_t j = f.even.size(); j-- > 0;) {
        sum = (sum + f.even[j]) * u;
        slope = slope * u + double(j + 1) * f.even[j];
    }
    s.z = s.z + sum;
    T pull = 2.0 * slope;  // slopes are pull * (x, y)
    if (!f.odd.empty()) {
        const T r = sqrt(u);
        T odd = 0, odd_slope = 0;
        for (std::size_t j = f.odd.size(); j-- > 0;) {
            odd = odd * u + f.odd[j];
            odd_slope = odd_slope * u + double(2 * j + 1) * f.odd[j];
        }
        s.z = s.z + odd * r;
        if (value_of(r) > 0) pull = pull + odd_slope / r;
    }
    s.slope_x = s.slope_x + pull * x, s.slope_y = s.slope_y + pull * y;
}

}  // namespace form_detail

/// Sag of the surface at (x, y) in its local frame.
template <typename T>
Sag<T> sag(const SurfaceForm& f, const T& x, const T& y) {
    Sag<T> s = f.shape == Shape::conic     ? form_detail::conic(f.cy, f.ky, x, y)
               : f.shape == Shape::biconic ? form_detail::biconic(f, x, y)
                                           : form_detail::toroid(f, x, y);
    if (!f.even.empty() || !f.odd.empty()) form_detail::add_asphere(f, x, y, s);
    return s;
}

}  // namespace dg
