// meet-inl.h -- intersection of rays with a surface in SIMD lanes (intersect.h in float). Included
// once per instruction set.
#if defined(DG_OPTICS_MEET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_MEET_INL_H_
#undef DG_OPTICS_MEET_INL_H_
#else
#define DG_OPTICS_MEET_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/trace/lens_tables.h"
#include "optics/trace/transmission-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

struct LaneVec {
    V x, y, z;
};

HWY_INLINE V dot_lanes(const LaneVec& a, const LaneVec& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
/// p + t d
HWY_INLINE LaneVec along(const LaneVec& p, V t, const LaneVec& d) {
    return {hn::MulAdd(t, d.x, p.x), hn::MulAdd(t, d.y, p.y), hn::MulAdd(t, d.z, p.z)};
}

/// Intersection. The unit normal is (-bend_x x, -bend_y y, axial); the cosine of incidence is
/// positive.
struct LaneHit {
    LaneVec point;
    V bend_x, bend_y, axial;
    V cos1, cos1_squared;
    M ok;
};

template <int kSign>
HWY_INLINE V signed_by(V v) {
    return kSign > 0 ? v : hn::Neg(v);
}

template <int kSign>
HWY_INLINE LaneHit meet_plane(const LaneVec& p, const LaneVec& d) {
    const V zero = hn::Zero(D());
    LaneHit h;
    h.point = along(p, hn::Neg(hn::Div(p.z, d.z)), d);
    h.point.z = zero;
    h.bend_x = h.bend_y = zero, h.axial = constant(1);
    h.cos1 = signed_by<kSign>(d.z), h.cos1_squared = hn::Mul(d.z, d.z);
    h.ok = hn::Gt(h.cos1, zero);
    return h;
}

/// Intersection with a centred sphere, computed from the ray's point nearest to the vertex.
template <int kSign>
HWY_INLINE LaneHit meet_sphere(float curvature, const LaneVec& p, const LaneVec& d) {
    const V c = constant(curvature), zero = hn::Zero(D());
    const LaneVec m = along(p, hn::Neg(dot_lanes(p, d)), d);
    const V q = hn::MulSub(c, dot_lanes(m, m), hn::Add(m.z, m.z));
    LaneHit h;
    h.cos1_squared = hn::NegMulAdd(c, q, hn::Mul(d.z, d.z));
    h.cos1 = hn::Sqrt(h.cos1_squared);
    h.point = along(m, hn::Div(q, hn::Add(d.z, signed_by<kSign>(h.cos1))), d);
    h.bend_x = h.bend_y = c;
    h.axial = hn::NegMulAdd(c, h.point.z, constant(1));
    h.ok = hn::And(hn::Ge(h.cos1_squared, zero), hn::Gt(h.axial, zero));
    return h;
}

/// Normalizes the normal; `speed` is the dot product of the unnormalized normal and the direction.
template <int kSign>
HWY_INLINE void normalize_hit(V speed, LaneHit& h) {
    const V nx = hn::Mul(h.bend_x, h.point.x), ny = hn::Mul(h.bend_y, h.point.y);
    const V n2 = hn::MulAdd(nx, nx, hn::MulAdd(ny, ny, hn::Mul(h.axial, h.axial)));
    const V inverse = hn::Div(constant(1), hn::Sqrt(n2));
    h.bend_x = hn::Mul(h.bend_x, inverse), h.bend_y = hn::Mul(h.bend_y, inverse);
    h.axial = hn::Mul(h.axial, inverse);
    h.cos1 = hn::Mul(signed_by<kSign>(speed), inverse);
    h.cos1_squared = hn::Mul(h.cos1, h.cos1);
}

/// Ray parameter from m of the crossing with c (wx x^2 + wy y^2 + wz z^2) = 2 z; also returns the
/// discriminant.
template <int kSign>
HWY_INLINE V quadric_crossing(const ShapeTables& s, const LaneVec& m, const LaneVec& d,
                              V& discriminant) {
    const V c = constant(s.c), wx = constant(s.wx), wy = constant(s.wy),
            wz = constant(s.wz);
    const LaneVec w{hn::Mul(wx, m.x), hn::Mul(wy, m.y), hn::Mul(wz, m.z)};
    const V q = hn::MulSub(c, dot_lanes(w, m), hn::Add(m.z, m.z));
    const V b = hn::NegMulAdd(c, dot_lanes(w, d), d.z);
    const LaneVec v{hn::Mul(wx, d.x), hn::Mul(wy, d.y), hn::Mul(wz, d.z)};
    const V a = hn::Mul(c, dot_lanes(v, d));
    discriminant = hn::NegMulAdd(a, q, hn::Mul(b, b));
    const V root = hn::Sqrt(hn::Max(discriminant, hn::Zero(D())));
    return hn::Div(q, hn::Add(b, signed_by<kSign>(root)));
}

template <int kSign>
HWY_INLINE LaneHit meet_quadric(const ShapeTables& s, const LaneVec& p,
                                const LaneVec& d) {
    const V zero = hn::Zero(D());
    const LaneVec m = along(p, hn::Neg(dot_lanes(p, d)), d);
    V discriminant;
    LaneHit h;
    h.point = along(m, quadric_crossing<kSign>(s, m, d, discriminant), d);
    h.bend_x = constant(s.c * s.wx), h.bend_y = constant(s.c * s.wy);
    h.axial = hn::NegMulAdd(constant(s.c * s.wz), h.point.z, constant(1));
    h.ok = hn::And(hn::Ge(discriminant, zero), hn::Gt(h.axial, zero));
    normalize_hit<kSign>(signed_by<kSign>(hn::Sqrt(discriminant)), h);
    return h;
}

/// Asphere at r^2 = u: its height, and its slope in x divided by x.
HWY_INLINE void asphere_lanes(const ShapeTables& s, V u, V& height, V& pull) {
    const V zero = hn::Zero(D()), v = hn::Mul(u, constant(s.inverse_scale2));
    V even = zero, even_slope = zero;  // derivatives by v
    for (std::size_t j = s.even.size(); j-- > 0;) {
        even = hn::Mul(hn::Add(even, constant(s.even[j])), v);
        even_slope = hn::MulAdd(even_slope, v, constant(s.even_slope[j]));
    }
    height = even, pull = even_slope;
    if (!s.odd.empty()) {
        V odd = zero, odd_slope = zero;
        for (std::size_t j = s.odd.size(); j-- > 0;) {
            odd = hn::MulAdd(odd, v, constant(s.odd[j]));
            odd_slope = hn::MulAdd(odd_slope, v, constant(s.odd_slope[j]));
        }
        const V r = hn::Sqrt(v);
        height = hn::MulAdd(odd, r, height);
        pull = hn::Add(pull, hn::IfThenElseZero(hn::Gt(r, zero), hn::Div(odd_slope, r)));
    }
    pull = hn::Mul(pull, constant(s.inverse_scale2));
}

/// sqrt(v), clamped where the form is undefined; clears `defined` there.
HWY_INLINE V domed_root(V v, M& defined) {
    defined = hn::And(defined, hn::Gt(v, hn::Zero(D())));
    return hn::Sqrt(hn::Max(v, constant(1e-6f)));
}

/// Signed distance past the surface along z, and its gradient in the form of LaneHit's normal; both
/// are scaled by a common factor that is positive on the near side. z minus the asphere satisfies
/// the equation of the base form (sections: form.h).
HWY_INLINE V past_surface(const ShapeTables& s, LaneHit& h) {
    const V one = constant(1), x = h.point.x, y = h.point.y;
    const V x2 = hn::Mul(x, x), y2 = hn::Mul(y, y);
    V z = h.point.z, pull = hn::Zero(D());
    if (s.has_asphere) {
        V height;
        asphere_lanes(s, hn::Add(x2, y2), height, pull);
        z = hn::Sub(z, height);
    }
    if (s.shape == Shape::conic) {  // implicit form c (r^2 + (1+k) z^2) = 2 z: no square root
        const V c = constant(s.c), half = constant(0.5f * s.c), cz = constant(s.c * s.wz);
        h.axial = hn::NegMulAdd(cz, z, one);
        h.bend_x = h.bend_y = hn::MulAdd(h.axial, pull, c);
        const V r2 = hn::Add(x2, y2), wz = hn::Mul(constant(s.wz), z);
        return hn::NegMulAdd(half, hn::MulAdd(wz, z, r2), z);
    }
    const V cx = constant(s.cx), cy = constant(s.cy);
    h.axial = one;
    if (s.shape == Shape::biconic) {
        const V px = constant(s.px), py = constant(s.py);
        const V root =
            domed_root(hn::NegMulAdd(px, x2, hn::NegMulAdd(py, y2, one)), h.ok);
        const V inverse = hn::Div(one, hn::Add(one, root));
        const V base = hn::Mul(hn::MulAdd(cx, x2, hn::Mul(cy, y2)), inverse);
        const V more = hn::Div(hn::Mul(base, inverse), root);
        const V twice = hn::Add(inverse, inverse);
        h.bend_x = hn::MulAdd(cx, twice, hn::MulAdd(px, more, pull));
        h.bend_y = hn::MulAdd(cy, twice, hn::MulAdd(py, more, pull));
        return hn::Sub(z, base);
    }
    const V section_root = domed_root(hn::NegMulAdd(constant(s.py), y2, one), h.ok);
    const V g = hn::Div(hn::Mul(cy, y2), hn::Add(one, section_root));
    const V height = hn::MulAdd(cx, hn::NegMulAdd(g, g, x2), hn::Add(g, g));
    const V root = domed_root(hn::NegMulAdd(cx, height, one), h.ok);
    const V base = hn::Div(height, hn::Add(one, root));
    h.bend_x = hn::Add(hn::Div(cx, root), pull);
    const V section = hn::Div(hn::Mul(cy, hn::NegMulAdd(cx, g, one)), section_root);
    h.bend_y = hn::Add(hn::Div(section, root), pull);
    return hn::Sub(z, base);
}

HWY_INLINE void keep_lanes(M which, const LaneHit& from, LaneHit& to) {
    to.point.x = hn::IfThenElse(which, from.point.x, to.point.x);
    to.point.y = hn::IfThenElse(which, from.point.y, to.point.y);
    to.point.z = hn::IfThenElse(which, from.point.z, to.point.z);
    to.bend_x = hn::IfThenElse(which, from.bend_x, to.bend_x);
    to.bend_y = hn::IfThenElse(which, from.bend_y, to.bend_y);
    to.axial = hn::IfThenElse(which, from.axial, to.axial);
    to.ok = hn::Or(hn::And(which, from.ok), hn::AndNot(which, to.ok));
}

/// Newton's method for two vectors of rays, started at the base form. Lanes that have not converged
/// after the last step count as misses. Converged lanes stay frozen while others iterate, so that a
/// ray's bits do not depend on its neighbours.
template <int kSign>
HWY_INLINE void meet_searched(const ShapeTables& s, const LaneVec (&p)[2],
                              const LaneVec (&d)[2], const M (&alive)[2],
                              LaneHit (&h)[2]) {
    const D tag;
    const V zero = hn::Zero(tag), stride = constant(s.stride);
    V speed[2] = {zero, zero};
    M rest[2];
    for (int v = 0; v < 2; ++v) {
        rest[v] = hn::Lt(zero, zero);
        const LaneVec m = along(p[v], hn::Neg(dot_lanes(p[v], d[v])), d[v]);
        V discriminant;
        h[v].point = along(m, quadric_crossing<kSign>(s, m, d[v], discriminant), d[v]);
        h[v].bend_x = h[v].bend_y = h[v].axial = zero, h[v].ok = rest[v];
    }
    for (int step = 0; step < 12; ++step) {
        for (int v = 0; v < 2; ++v) {
            LaneHit next = h[v];
            next.ok = hn::Eq(zero, zero);
            const V past = past_surface(s, next);
            const V slide =
                hn::MulAdd(hn::Mul(next.bend_x, next.point.x), d[v].x,
                           hn::Mul(hn::Mul(next.bend_y, next.point.y), d[v].y));
            const V fall = hn::MulSub(next.axial, d[v].z, slide);
            const V free = hn::Div(past, fall);
            const V t = hn::Max(hn::Min(free, stride), hn::Neg(stride));
            next.point = along(next.point, hn::Neg(t), d[v]);
            keep_lanes(rest[v], h[v], next);
            speed[v] = hn::IfThenElse(rest[v], speed[v], fall);
            h[v] = next;
            rest[v] = hn::Or(rest[v], hn::Lt(hn::Abs(t), constant(s.tolerance)));
        }
        const M moving =
            hn::Or(hn::AndNot(rest[0], alive[0]), hn::AndNot(rest[1], alive[1]));
        if (hn::AllFalse(tag, moving)) break;
    }
    for (int v = 0; v < 2; ++v) {
        normalize_hit<kSign>(speed[v], h[v]);
        const M near = hn::And(hn::Gt(h[v].axial, zero), hn::Gt(h[v].cos1, zero));
        h[v].ok = hn::And(h[v].ok, hn::And(rest[v], near));
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
