// free_pupil-inl.h -- aim of a lens without axial symmetry in SIMD lanes. Included once per
// instruction set.
#if defined(DG_OPTICS_FREE_PUPIL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_FREE_PUPIL_INL_H_
#undef DG_OPTICS_FREE_PUPIL_INL_H_
#else
#define DG_OPTICS_FREE_PUPIL_INL_H_
#endif

#include "optics/aim/pupil-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Film point f in [-1, 1], and its cell.
struct LaneFilm {
    V fx, fy;
    VI cell;
    M covered;
};

HWY_INLINE LaneFilm free_film(const FreeAimTables& aim, V x, V y) {
    LaneFilm f;
    const auto unit = [](V at, float center, float half) {
        return hn::Mul(hn::Sub(at, constant(center)), constant(1 / half));
    };
    const auto cell = [](V at) {
        const V scaled = hn::MulAdd(at, constant(kFilmCells / 2.f), constant(kFilmCells / 2.f));
        return hn::ConvertTo(
            DI(), hn::Max(constant(0), hn::Min(scaled, constant(kFilmCells - 0.5f))));
    };
    f.fx = unit(x, aim.center_x, aim.half_x);
    f.fy = unit(y, aim.center_y, aim.half_y);
    f.covered = hn::And(hn::Le(hn::Abs(f.fx), constant(1)), hn::Le(hn::Abs(f.fy), constant(1)));
    f.cell = hn::Add(cell(f.fx), hn::Mul(cell(f.fy), hn::Set(DI(), kFilmCells)));
    return f;
}

/// FreePolynomial::evaluate in lanes.
HWY_NOINLINE LaneSlope free_slope_lanes(const float* c, int degree, V fx, V fy, V ax, V ay, V l) {
    const V zero = constant(0);
    V mx = zero, my = zero, mx_x = zero, my_x = zero, mx_y = zero, my_y = zero;
    for (int i = degree; i >= 0; --i) {
        V row_x = zero, row_y = zero, slope_x = zero, slope_y = zero;
        for (int j = degree - i; j >= 0; --j) {
            V film_x = zero, film_y = zero;
            for (int p = degree - i - j; p >= 0; --p) {
                V in_x = zero, in_y = zero;
                for (int q = degree - i - j - p; q >= 0; --q) {
                    V lx = constant(c[0]), ly = constant(c[1]);
                    c += 2;
                    for (int r = (degree - i - j - p - q) / 2; r > 0; --r, c += 2) {
                        lx = hn::MulAdd(lx, l, constant(c[0]));
                        ly = hn::MulAdd(ly, l, constant(c[1]));
                    }
                    in_x = hn::MulAdd(in_x, fy, lx);
                    in_y = hn::MulAdd(in_y, fy, ly);
                }
                film_x = hn::MulAdd(film_x, fx, in_x);
                film_y = hn::MulAdd(film_y, fx, in_y);
            }
            slope_x = hn::MulAdd(slope_x, ay, row_x);
            slope_y = hn::MulAdd(slope_y, ay, row_y);
            row_x = hn::MulAdd(row_x, ay, film_x);
            row_y = hn::MulAdd(row_y, ay, film_y);
        }
        mx_x = hn::MulAdd(mx_x, ax, mx);
        my_x = hn::MulAdd(my_x, ax, my);
        mx = hn::MulAdd(mx, ax, row_x);
        my = hn::MulAdd(my, ax, row_y);
        mx_y = hn::MulAdd(mx_y, ax, slope_x);
        my_y = hn::MulAdd(my_y, ax, slope_y);
    }
    return {mx, my, mx_x, mx_y, my_x, my_y};
}

HWY_INLINE LaneSlope free_slope_at(const FreeAimTables& aim, const LaneFilm& f, V ax, V ay, V l) {
    return free_slope_lanes(aim.coefficients.data(), aim.degree, f.fx, f.fy, ax, ay, l);
}

/// Weight A' J cos(theta_film) / (1+m^2)^(3/2): the film's normal may differ from the axis.
HWY_INLINE V film_weight(const FreeAimTables& aim, V area_jacobian, V mx, V my) {
    const V facing = hn::MulAdd(constant(aim.normal[0]), mx,
                                hn::MulAdd(constant(aim.normal[1]), my, constant(aim.normal[2])));
    return slope_weight(hn::Mul(area_jacobian, hn::Max(facing, constant(0))), mx, my);
}

HWY_INLINE LaneAim draw_free_lanes(const LensTables& lens, const AimTables& aim, V x, V y, V u,
                                   V v, V l) {
    const D d;
    const FreeAimTables& t = aim.free;
    const LaneFilm f = free_film(t, x, y);
    V ax, ay;
    shape_lanes(lens.iris, aim.enlargement, u, v, ax, ay);
    const V to_unit = constant(1 / aim.iris_scale);
    ax = hn::Mul(ax, to_unit), ay = hn::Mul(ay, to_unit);
    const V region = hn::GatherIndex(d, t.region.data(), f.cell);
    const M columns = hn::Gt(region, constant(0.5f)), direct = hn::Gt(region, constant(1.5f));
    const VI k =
        hn::Add(split(u, kColumns), hn::Mul(f.cell, hn::Set(DI(), kColumns + 1)));
    const V left = hn::GatherIndex(d, t.column_x.data(), k),
            right = hn::GatherIndex(d, t.column_x.data() + 1, k),
            low = hn::GatherIndex(d, t.column_low.data(), k),
            high = hn::GatherIndex(d, t.column_high.data(), k);
    ax = hn::IfThenElse(columns, hn::MulAdd(u, hn::Sub(right, left), left), ax);
    ay = hn::IfThenElse(columns, hn::MulAdd(v, hn::Sub(high, low), low), ay);
    const LaneSlope s = free_slope_at(t, f, ax, ay, l);
    const V j = hn::IfThenElse(direct, constant(1), hn::Abs(jacobian(s)));
    LaneAim o;
    o.mx = hn::IfThenElse(direct, ax, s.mx);
    o.my = hn::IfThenElse(direct, ay, s.my);
    const V area = hn::GatherIndex(d, t.area.data(), f.cell);
    o.weight = hn::IfThenElseZero(f.covered, film_weight(t, hn::Mul(area, j), o.mx, o.my));
    return o;
}

/// weight_lanes for a lens without symmetry.
HWY_INLINE V weight_free_lanes(const AimTables& aim, V x, V y, V mx, V my, V qx, V qy, V l) {
    const D d;
    const FreeAimTables& t = aim.free;
    const LaneFilm f = free_film(t, x, y);
    const V to_unit = constant(1 / aim.iris_scale);
    V ax = hn::Mul(to_unit, qx), ay = hn::Mul(to_unit, qy), j = constant(1);
    for (int step = 0; step < 3; ++step) {
        const LaneSlope s = free_slope_at(t, f, ax, ay, l);
        j = jacobian(s);
        if (step == 2) break;
        const V ex = hn::Sub(mx, s.mx), ey = hn::Sub(my, s.my), inv = hn::Div(constant(1), j);
        ax = hn::MulAdd(inv, hn::MulSub(s.m22, ex, hn::Mul(s.m12, ey)), ax);
        ay = hn::MulAdd(inv, hn::MulSub(s.m11, ey, hn::Mul(s.m21, ex)), ay);
    }
    const V region = hn::GatherIndex(d, t.region.data(), f.cell);
    j = hn::IfThenElse(hn::Gt(region, constant(1.5f)), constant(1), hn::Abs(j));
    const V area = hn::GatherIndex(d, t.area.data(), f.cell);
    return hn::IfThenElseZero(f.covered, film_weight(t, hn::Mul(area, j), mx, my));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
