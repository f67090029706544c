// transmission-inl.h -- how much light a surface lets through, in SIMD lanes. Included
// once per instruction set.
#if defined(DG_OPTICS_TRANSMISSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_TRANSMISSION_INL_H_
#undef DG_OPTICS_TRANSMISSION_INL_H_
#else
#define DG_OPTICS_TRANSMISSION_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/pupil_tables.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using DI = hn::RebindToSigned<D>;
using VI = hn::Vec<DI>;

HWY_INLINE V constant(float value) {
    return hn::Set(D(), value);
}

/// Rays at a surface: indices and cosines of the side that they come from (1) and of the
/// side that they go to (2), and their wavelength.
struct LaneCrossing {
    V n1, cos1, cos1_squared;
    V n2, cos2;
    V l, inv_um;
};

/// coating.h's airy_transmittance as numerator and denominator (numerator without its
/// factor 8).
HWY_INLINE void airy(V p, V q, V r, V cos_2b, V& numerator, V& denominator) {
    const V p2 = hn::Mul(p, p), q2 = hn::Mul(q, q), r2 = hn::Mul(r, r);
    const V m = hn::Mul(q2, hn::Mul(p, r));
    const V sums = hn::Mul(hn::Add(p2, q2), hn::Add(q2, r2));
    const V differences = hn::Mul(hn::Sub(p2, q2), hn::Sub(q2, r2));
    denominator = hn::MulAdd(differences, cos_2b, hn::MulAdd(m, constant(4), sums));
    numerator = m;
}

/// coating.h's film_transmittance. cos(2b) = -cos(2b - pi), by Taylor: |2b - pi| < 1.7,
/// error < 2e-6.
HWY_INLINE V film_lanes(V n1, V cos1, V cos1_squared, V n2, V cos2, V inv_um) {
    const V one = constant(1), nf = constant(float(kFilmIndex));
    const V sin_f = hn::Mul(n1, constant(float(1 / kFilmIndex)));
    const V cos_f =
        hn::Sqrt(hn::NegMulAdd(hn::Mul(sin_f, sin_f), hn::Sub(one, cos1_squared), one));
    const V phase =
        hn::MulAdd(hn::Mul(inv_um, constant(float(kPiD * kFilmWavelength * 1e-3))), cos_f,
                   constant(float(-kPiD)));
    const V w = hn::Mul(phase, phase);
    V cosine = hn::MulAdd(w, constant(-1.f / 3628800), constant(1.f / 40320));
    cosine = hn::MulAdd(cosine, w, constant(-1.f / 720));
    cosine = hn::MulAdd(cosine, w, constant(1.f / 24));
    cosine = hn::MulAdd(cosine, w, constant(-0.5f));
    const V cos_2b = hn::NegMulAdd(cosine, w, constant(-1));
    V ns, ds, np, dp;
    airy(hn::Mul(n1, cos1), hn::Mul(nf, cos_f), hn::Mul(n2, cos2), cos_2b, ns, ds);
    airy(hn::Mul(n1, hn::Mul(cos_f, cos2)), hn::Mul(nf, hn::Mul(cos1, cos2)),
         hn::Mul(n2, hn::Mul(cos1, cos_f)), cos_2b, np, dp);
    const V sum = hn::MulAdd(ns, dp, hn::Mul(np, ds));
    return hn::Div(hn::Mul(constant(4), sum), hn::Mul(ds, dp));
}

/// Ts + Tp over 2 of bare glass: T = 4pr / (p+r)^2 with admittances p, r.
HWY_INLINE V bare_lanes(V n1, V cos1, V n2, V cos2) {
    const V s = hn::MulAdd(n1, cos1, hn::Mul(n2, cos2));
    const V p = hn::MulAdd(n2, cos1, hn::Mul(n1, cos2));
    const V sp = hn::Mul(s, p);
    const V m = hn::Mul(hn::Mul(n1, n2), hn::Mul(cos1, cos2));
    const V numerator = hn::Mul(m, hn::MulAdd(s, s, hn::Mul(p, p)));
    return hn::Div(hn::Mul(constant(2), numerator), hn::Mul(sp, sp));
}

/// surface_transmittance() (coating.h) of surface i; kSign is +1 toward the film.
template <int kSign>
HWY_INLINE V transmission_lanes(const LensTables& lens, int i, const LaneCrossing& at) {
    if (lens.light[i] == SurfaceLight::film)
        return film_lanes(at.n1, at.cos1, at.cos1_squared, at.n2, at.cos2, at.inv_um);
    return bare_lanes(at.n1, at.cos1, at.n2, at.cos2);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
