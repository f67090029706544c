// transmission-inl.h -- transmittance of surfaces and glass in SIMD lanes. Included once per
// instruction set.
#if defined(DG_OPTICS_TRANSMISSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_TRANSMISSION_INL_H_
#undef DG_OPTICS_TRANSMISSION_INL_H_
#else
#define DG_OPTICS_TRANSMISSION_INL_H_
#endif

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "optics/trace/lens_tables.h"

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

/// Refraction at a surface: index and cosine on the incident side (1) and on the other side (2),
/// and the wavelength variable.
struct LaneCrossing {
    V n1, cos1;
    V n2, cos2;
    V l;
};

/// Transmittance of a coated surface from its table (coating_table.h).
HWY_INLINE V coating_lanes(const CoatingTable& table, V cosine, V l) {
    const V x = hn::MulAdd(cosine, constant(2), constant(-1));
    const V root = hn::MulAdd(cosine, constant(table.pole), constant(1));
    const float* c = table.coefficients.data();
    V sum = hn::Zero(D());
    for (const int terms : table.terms) {
        V row = constant(c[0]);
        for (int m = 1; m < terms; ++m) row = hn::MulAdd(row, l, constant(c[m]));
        sum = hn::MulAdd(sum, x, row);
        c += terms;
    }
    return hn::Div(hn::Mul(cosine, sum), hn::Mul(root, root));
}

/// Transmittance (Ts + Tp) / 2 of bare glass: T = 4pr / (p+r)^2 with admittances p, r.
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
    if (lens.fresnel[i] == FresnelModel::coated) {
        const bool rarer_first = bool(lens.rarer_in_front[i]) == (kSign > 0);
        return coating_lanes(lens.coatings[i], rarer_first ? at.cos1 : at.cos2, at.l);
    }
    return bare_lanes(at.n1, at.cos1, at.n2, at.cos2);
}

/// absorption_per_mm() (glass.h) of a medium, interpolated linearly in its table.
HWY_INLINE V absorption_lanes(const AbsorptionTables& t, int medium, V l) {
    const D d;
    const V last = constant(float(t.kNodes - 1));
    const V at = hn::Mul(hn::Mul(hn::Add(l, constant(1)), last), constant(0.5f));
    const V node = hn::Floor(hn::Clamp(at, hn::Zero(d), hn::Sub(last, constant(1))));
    const V u = hn::Clamp(hn::Sub(at, node), hn::Zero(d), constant(1));
    const VI index = hn::ConvertTo(DI(), node);
    const float* per_mm = t.per_mm.data() + medium * t.kNodes;
    const V a = hn::GatherIndex(d, per_mm, index), b = hn::GatherIndex(d, per_mm + 1, index);
    return hn::MulAdd(u, hn::Sub(b, a), a);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
