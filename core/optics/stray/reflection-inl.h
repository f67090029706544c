// reflection-inl.h -- reflectance of surfaces in SIMD lanes. Coatings are evaluated exactly, since
// a ghost is the product of two small reflectances. Included once per instruction set.
#if defined(DG_OPTICS_REFLECTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_REFLECTION_INL_H_
#undef DG_OPTICS_REFLECTION_INL_H_
#else
#define DG_OPTICS_REFLECTION_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/stray/ghost_lens.h"
#include "optics/trace/transmission-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Characteristic matrix [[a, i b], [i c, d]] of a film stack for one polarization (coating.cpp).
struct LaneFilms {
    V a, b, c, d;

    HWY_INLINE void clear() {
        a = d = constant(1), b = c = hn::Zero(D());
    }
    HWY_INLINE void add(V cosine, V sine, V admittance) {
        const V b2 = hn::Div(sine, admittance), c2 = hn::Mul(sine, admittance);
        const V a1 = a, b1 = b, c1 = c, d1 = d;
        a = hn::NegMulAdd(b1, c2, hn::Mul(a1, cosine));
        b = hn::MulAdd(a1, b2, hn::Mul(b1, cosine));
        c = hn::MulAdd(c1, cosine, hn::Mul(d1, c2));
        d = hn::NegMulAdd(c1, b2, hn::Mul(d1, cosine));
    }
    /// Reflectance |p B - C|^2 / |p B + C|^2 with (B, C) = M (1, q), where p and q are the
    /// admittances of the media.
    HWY_INLINE V reflectance(V p, V q) const {
        const V pa = hn::Mul(p, a), qd = hn::Mul(q, d), pqb = hn::Mul(hn::Mul(p, q), b);
        const V r0 = hn::Sub(pa, qd), i0 = hn::Sub(pqb, c), r1 = hn::Add(pa, qd), i1 = hn::Add(pqb, c);
        return hn::Div(hn::MulAdd(r0, r0, hn::Mul(i0, i0)), hn::MulAdd(r1, r1, hn::Mul(i1, i1)));
    }
};

/// Reflectance of films ordered from the rarer medium (n1, cos1) to the denser. Not inlined: the
/// inlined sines doubled compile time.
static HWY_NOINLINE V films_reflectance(const MirrorTables& mirror, V n1, V cos1, V n2, V cos2, V inv_um2) {
    const D d;
    const V one = constant(1);
    const V sine2 = hn::Mul(hn::Mul(n1, n1), hn::NegMulAdd(cos1, cos1, one));
    const V inv_um = hn::Sqrt(inv_um2);
    LaneFilms s, p;
    s.clear(), p.clear();
    for (const MirrorTables::Layer& film : mirror.layers) {
        const V n = hn::MulAdd(constant(film.b), inv_um2, constant(film.a));
        const V normal = hn::Sqrt(hn::Max(hn::MulSub(n, n, sine2), constant(1e-6f)));
        const V phase = hn::Mul(hn::Mul(normal, inv_um), constant(2 * kPi * film.um));
        const V sine = hn::Sin(d, phase), cosine = hn::Cos(d, phase);
        s.add(cosine, sine, normal);
        p.add(cosine, sine, hn::Div(hn::Mul(n, n), normal));
    }
    const V least = constant(1e-6f), c1 = hn::Max(cos1, least), c2 = hn::Max(cos2, least);
    const V both = hn::Add(s.reflectance(hn::Mul(n1, c1), hn::Mul(n2, c2)),
                           p.reflectance(hn::Div(n1, c1), hn::Div(n2, c2)));
    return hn::Mul(constant(0.5f), both);
}

/// Fresnel reflectance (rs^2 + rp^2) / 2.
HWY_INLINE V bare_reflectance(V n1, V cos1, V n2, V cos2) {
    const V p1 = hn::Mul(n1, cos1), q2 = hn::Mul(n2, cos2), p2 = hn::Mul(n2, cos1), q1 = hn::Mul(n1, cos2);
    const V rs = hn::Div(hn::Sub(p1, q2), hn::Add(p1, q2)), rp = hn::Div(hn::Sub(p2, q1), hn::Add(p2, q1));
    return hn::Mul(constant(0.5f), hn::MulAdd(rs, rs, hn::Mul(rp, rp)));
}

/// Reflectance 1 - surface_transmittance(); cos2_squared < 0 means total reflection.
HWY_INLINE V reflectance_lanes(const LensTables& lens, const MirrorTables& mirror, const LaneCrossing& at,
                               V cos2_squared, bool rarer_first) {
    using Kind = MirrorTables::Kind;
    if (mirror.kind == Kind::none) return hn::Zero(D());
    if (mirror.kind == Kind::constant) return constant(mirror.reflectance);
    V r;
    if (mirror.kind == Kind::bare) {
        r = bare_reflectance(at.n1, at.cos1, at.n2, at.cos2);
    } else {
        const V inv_um2 = hn::Mul(hn::Sub(at.l, constant(lens.scale.offset)), constant(1 / lens.scale.scale));
        r = rarer_first ? films_reflectance(mirror, at.n1, at.cos1, at.n2, at.cos2, inv_um2)
                        : films_reflectance(mirror, at.n2, at.cos2, at.n1, at.cos1, inv_um2);
    }
    return hn::IfThenElse(hn::Lt(cos2_squared, hn::Zero(D())), constant(1), r);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
