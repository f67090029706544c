// pupil-inl.h -- sampling of iris points and evaluation of the aim in SIMD lanes. Included once per
// instruction set.
#if defined(DG_OPTICS_PUPIL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_PUPIL_INL_H_
#undef DG_OPTICS_PUPIL_INL_H_
#else
#define DG_OPTICS_PUPIL_INL_H_
#endif

#include "optics/aim/aim_tables.h"
#include "optics/trace/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// concentric_disc (stop.h) in lanes. The angle stays within pi/4, so short Taylor series suffice.
HWY_INLINE void disc_lanes(V u, V v, V& x, V& y) {
    const D d;
    const V a = hn::MulAdd(u, constant(2), constant(-1)),
            b = hn::MulAdd(v, constant(2), constant(-1));
    const M steep = hn::Gt(hn::Abs(b), hn::Abs(a));
    const V r = hn::IfThenElse(steep, b, a), other = hn::IfThenElse(steep, a, b);
    const V safe = hn::IfThenElse(hn::Eq(r, hn::Zero(d)), constant(1), r);
    const V t = hn::Mul(hn::Div(other, safe), constant(float(kPiD / 4)));
    const V w = hn::Mul(t, t);
    V s = hn::MulAdd(w, constant(1.f / 362880), constant(-1.f / 5040));
    s = hn::MulAdd(s, w, constant(1.f / 120));
    s = hn::MulAdd(s, w, constant(-1.f / 6));
    s = hn::MulAdd(hn::Mul(s, w), t, t);
    V c = hn::MulAdd(w, constant(1.f / 40320), constant(-1.f / 720));
    c = hn::MulAdd(c, w, constant(1.f / 24));
    c = hn::MulAdd(c, w, constant(-0.5f));
    c = hn::MulAdd(c, w, constant(1));
    const V rc = hn::Mul(r, c), rs = hn::Mul(r, s);
    x = hn::IfThenElse(steep, rs, rc);
    y = hn::IfThenElse(steep, rc, rs);
}

/// Splits u into a table index and the fraction within that entry.
HWY_INLINE VI split(V& u, std::size_t size) {
    const V scaled = hn::Mul(u, constant(float(size)));
    const VI i = hn::ConvertTo(DI(), hn::Min(scaled, constant(float(size) - 0.5f)));
    u = hn::Sub(scaled, hn::ConvertTo(D(), i));
    return i;
}

/// Iris::sample in lanes, mm.
HWY_INLINE void shape_lanes(const IrisTables& iris, float enlargement, V u, V v, V& x,
                            V& y) {
    const D d;
    V scale = constant(enlargement);
    if (iris.kind == Iris::Kind::round) {
        disc_lanes(u, v, x, y);
        scale = hn::Mul(scale, constant(iris.radius));
    } else if (iris.kind == Iris::Kind::image) {
        const VI i = split(u, iris.support_x.size());
        x = hn::MulAdd(u, constant(iris.pixel),
                       hn::GatherIndex(d, iris.support_x.data(), i));
        y = hn::MulAdd(v, constant(iris.pixel),
                       hn::GatherIndex(d, iris.support_y.data(), i));
    } else {
        const VI i = split(u, iris.fan_x.size() - 1);
        const V t = u, rest = hn::Sub(constant(1), t);
        const float *fx = iris.fan_x.data(), *fy = iris.fan_y.data();
        x = hn::MulAdd(t, hn::GatherIndex(d, fx + 1, i),
                       hn::Mul(rest, hn::GatherIndex(d, fx, i)));
        y = hn::MulAdd(t, hn::GatherIndex(d, fy + 1, i),
                       hn::Mul(rest, hn::GatherIndex(d, fy, i)));
        scale = hn::Mul(scale, hn::Sqrt(v));
    }
    x = hn::Mul(x, scale);
    y = hn::Mul(y, scale);
}

/// SlopePolynomial::evaluate in lanes.
struct LaneSlope {
    V mx, my, m11, m12, m21, m22;
};

/// Not inlined: callers share one unrolled copy per degree, which shortens compilation.
template <int K>
HWY_NOINLINE LaneSlope slope_lanes(const float* c, V r, V ax, V ay, V l) {
    const D d;
    const V s = hn::Mul(r, ax), u = hn::MulAdd(hn::Mul(r, r), constant(2), constant(-1));
    const V w =
        hn::MulAdd(hn::MulAdd(ax, ax, hn::Mul(ay, ay)), constant(2), constant(-1));
    V a = hn::Zero(d), b = a, as = a, bs = a, aw = a, bw = a;
    for (int i = K; i >= 0; --i) {
        V wa = hn::Zero(d), wb = wa, was = wa, wbs = wa;
        for (int j = K - i; j >= 0; --j) {
            V ua = hn::Zero(d), ub = ua;
            for (int p = K - i - j; p >= 0; --p) {
                const int top = (K - i - j - p) / 2;
                V la = constant(c[0]), lb = constant(c[1]);
                c += 2;
                for (int q = 0; q < top; ++q, c += 2) {
                    la = hn::MulAdd(la, l, constant(c[0]));
                    lb = hn::MulAdd(lb, l, constant(c[1]));
                }
                ua = hn::MulAdd(ua, u, la);
                ub = hn::MulAdd(ub, u, lb);
            }
            was = hn::MulAdd(was, w, wa);
            wbs = hn::MulAdd(wbs, w, wb);
            wa = hn::MulAdd(wa, w, ua);
            wb = hn::MulAdd(wb, w, ub);
        }
        as = hn::MulAdd(as, s, a);
        bs = hn::MulAdd(bs, s, b);
        a = hn::MulAdd(a, s, wa);
        b = hn::MulAdd(b, s, wb);
        aw = hn::MulAdd(aw, s, was);
        bw = hn::MulAdd(bw, s, wbs);
    }
    const V along = hn::Mul(constant(4), hn::MulAdd(r, aw, hn::Mul(ax, bw)));
    const V across = hn::Mul(constant(4), hn::Mul(ay, bw));
    LaneSlope o;
    o.mx = hn::MulAdd(r, a, hn::Mul(ax, b));
    o.my = hn::Mul(ay, b);
    o.m11 = hn::MulAdd(along, ax, hn::MulAdd(r, hn::MulAdd(r, as, hn::Mul(ax, bs)), b));
    o.m12 = hn::Mul(along, ay);
    o.m21 = hn::MulAdd(across, ax, hn::Mul(ay, hn::Mul(bs, r)));
    o.m22 = hn::MulAdd(across, ay, b);
    return o;
}

HWY_INLINE LaneSlope slope_at(const AimTables& aim, V r, V ax, V ay, V l) {
    const float* c = aim.coefficients.data();
    switch (aim.degree) {
        case 3:
            return slope_lanes<3>(c, r, ax, ay, l);
        case 4:
            return slope_lanes<4>(c, r, ax, ay, l);
        case 5:
            return slope_lanes<5>(c, r, ax, ay, l);
        default:
            return slope_lanes<6>(c, r, ax, ay, l);
    }
}

HWY_INLINE V jacobian(const LaneSlope& s) {
    return hn::MulSub(s.m11, s.m22, hn::Mul(s.m12, s.m21));
}

/// Film point in the meridional frame: radius / film_radius, and the direction of the frame's x
/// axis.
struct Meridian {
    V r, ex, ey;
    M covered;  // within the film radius of the aim
};

HWY_INLINE Meridian meridian_of(const AimTables& aim, V x, V y) {
    const D d;
    Meridian m;
    const V r = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
    const M center = hn::Le(r, constant(1e-12f));
    const V inv = hn::Div(constant(1), hn::IfThenElse(center, constant(1), r));
    m.ex = hn::IfThenElse(center, constant(1), hn::Mul(x, inv));
    m.ey = hn::IfThenElse(center, hn::Zero(d), hn::Mul(y, inv));
    m.r = hn::Mul(r, constant(1 / aim.film_radius));
    m.covered = hn::Le(m.r, constant(1));
    return m;
}

HWY_INLINE VI segment_of(V r) {
    const V scaled = hn::Mul(r, constant(float(kRadialSegments)));
    return hn::ConvertTo(DI(), hn::Min(scaled, constant(kRadialSegments - 0.5f)));
}

/// Sampled ray in the meridional frame of the film point.
struct LaneAim {
    V mx, my;  // slopes in the lens frame
    V weight;  // A' J / (1+m^2)^2
};

HWY_INLINE V slope_weight(V area_jacobian, V mx, V my) {
    const V one_m2 = hn::MulAdd(mx, mx, hn::MulAdd(my, my, constant(1)));
    return hn::Div(area_jacobian, hn::Mul(one_m2, one_m2));
}

HWY_INLINE LaneAim draw_lanes(const LensTables& lens, const AimTables& aim, V x, V y, V u,
                              V v, V l) {
    const D d;
    const Meridian f = meridian_of(aim, x, y);
    V sx, sy;
    shape_lanes(lens.iris, aim.enlargement, u, v, sx, sy);
    const V to_unit = constant(1 / aim.iris_scale);
    V ax = hn::Mul(to_unit, hn::MulAdd(sx, f.ex, hn::Mul(sy, f.ey)));
    V ay = hn::Mul(to_unit, hn::MulSub(sy, f.ex, hn::Mul(sx, f.ey)));
    V area = constant(aim.shape_area), region = hn::Zero(d);
    if (!aim.all_shape) {
        const VI i = segment_of(f.r);
        region = hn::GatherIndex(d, aim.region, i);
        const M columns = hn::Gt(region, constant(0.5f));
        const VI k = hn::Add(split(u, kColumns), hn::Mul(i, hn::Set(DI(), kColumns + 1)));
        const V left = hn::GatherIndex(d, aim.column_x, k),
                right = hn::GatherIndex(d, aim.column_x + 1, k),
                half = hn::GatherIndex(d, aim.column_half, k);
        ax = hn::IfThenElse(columns, hn::MulAdd(u, hn::Sub(right, left), left), ax);
        ay = hn::IfThenElse(columns, hn::Mul(half, hn::MulAdd(v, constant(2), constant(-1))),
                            ay);
        area = hn::GatherIndex(d, aim.area, i);
    }
    const LaneSlope s = slope_at(aim, f.r, ax, ay, l);
    V mx = s.mx, my = s.my, j = hn::Abs(jacobian(s));
    if (!aim.all_shape) {
        const M direct = hn::Gt(region, constant(1.5f));
        mx = hn::IfThenElse(direct, ax, mx);
        my = hn::IfThenElse(direct, ay, my);
        j = hn::IfThenElse(direct, constant(1), j);
    }
    LaneAim o;
    o.weight = hn::IfThenElseZero(f.covered, slope_weight(hn::Mul(area, j), mx, my));
    o.mx = hn::MulSub(mx, f.ex, hn::Mul(my, f.ey));
    o.my = hn::MulAdd(mx, f.ey, hn::Mul(my, f.ex));
    return o;
}

/// Weight that draw_lanes gives to the slope (mx, my), for a ray with the traced iris point (qx,
/// qy) in mm. Newton steps lead from this point to the iris point of the aim's polynomial.
HWY_INLINE V weight_lanes(const AimTables& aim, V x, V y, V mx, V my, V qx, V qy, V l) {
    const D d;
    const Meridian f = meridian_of(aim, x, y);
    const V tx = hn::MulAdd(mx, f.ex, hn::Mul(my, f.ey));  // slopes in the meridional frame
    const V ty = hn::MulSub(my, f.ex, hn::Mul(mx, f.ey));
    const V to_unit = constant(1 / aim.iris_scale);
    V ax = hn::Mul(to_unit, hn::MulAdd(qx, f.ex, hn::Mul(qy, f.ey)));
    V ay = hn::Mul(to_unit, hn::MulSub(qy, f.ex, hn::Mul(qx, f.ey)));
    V j = constant(1);
    for (int step = 0; step < 3; ++step) {
        const LaneSlope s = slope_at(aim, f.r, ax, ay, l);
        j = jacobian(s);
        if (step == 2) break;
        const V ex = hn::Sub(tx, s.mx), ey = hn::Sub(ty, s.my),
                inv = hn::Div(constant(1), j);
        ax = hn::MulAdd(inv, hn::MulSub(s.m22, ex, hn::Mul(s.m12, ey)), ax);
        ay = hn::MulAdd(inv, hn::MulSub(s.m11, ey, hn::Mul(s.m21, ex)), ay);
    }
    j = hn::Abs(j);
    V area = constant(aim.shape_area);
    if (!aim.all_shape) {
        const VI i = segment_of(f.r);
        const V region = hn::GatherIndex(d, aim.region, i);
        area = hn::GatherIndex(d, aim.area, i);
        j = hn::IfThenElse(hn::Gt(region, constant(1.5f)), constant(1), j);
    }
    return hn::IfThenElseZero(f.covered, slope_weight(hn::Mul(area, j), tx, ty));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
