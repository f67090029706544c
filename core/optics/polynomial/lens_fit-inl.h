// lens_fit-inl.h -- the polynomials of a fitted lens in SIMD lanes. Included once per
// instruction set.
#if defined(DG_OPTICS_LENS_FIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_LENS_FIT_INL_H_
#undef DG_OPTICS_LENS_FIT_INL_H_
#else
#define DG_OPTICS_LENS_FIT_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/polynomial/lens_fit_simd.h"
#include "optics/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Two vectors of rays at once: one's chains of dependent operations hide behind the
/// other's.
struct Pair {
    V a, b;
};
struct PairVec {
    Pair x, y;
};

template <typename F>
HWY_INLINE Pair each(F f, Pair p) {
    return {f(p.a), f(p.b)};
}
template <typename F>
HWY_INLINE Pair each(F f, Pair p, Pair q) {
    return {f(p.a, q.a), f(p.b, q.b)};
}

HWY_INLINE Pair add(Pair p, Pair q) {
    return {hn::Add(p.a, q.a), hn::Add(p.b, q.b)};
}
HWY_INLINE Pair sub(Pair p, Pair q) {
    return {hn::Sub(p.a, q.a), hn::Sub(p.b, q.b)};
}
HWY_INLINE Pair mul(Pair p, Pair q) {
    return {hn::Mul(p.a, q.a), hn::Mul(p.b, q.b)};
}
HWY_INLINE Pair mul_add(Pair p, Pair q, Pair r) {
    return {hn::MulAdd(p.a, q.a, r.a), hn::MulAdd(p.b, q.b, r.b)};
}
HWY_INLINE Pair both(float v) {
    return {constant(v), constant(v)};
}
HWY_INLINE Pair dot(const PairVec& p, const PairVec& q) {
    return mul_add(p.x, q.x, mul(p.y, q.y));
}
HWY_INLINE Pair load(const float* p) {
    const D d;
    return {hn::Load(d, p), hn::Load(d, p + hn::Lanes(d))};
}
HWY_INLINE void store(Pair v, float* p) {
    const D d;
    hn::Store(v.a, d, p), hn::Store(v.b, d, p + hn::Lanes(d));
}

/// Fills `values`, two vectors for each monomial, by the first runs of a program.
HWY_INLINE void run_program(const FitProgram& program, int runs, const Pair (&at)[5],
                            float* values) {
    const std::size_t step = 2 * hn::Lanes(D());
    store(both(1), values);
    for (int i = 0; i < runs; ++i) {
        const FitRun& run = program.runs[i];
        const Pair x = at[run.variable];
        const float* from = values + run.parent * step;
        float* to = values + run.first * step;
        for (int k = 0; k < run.count; ++k, from += step, to += step)
            store(mul(load(from), x), to);
    }
}

/// kCount neighbouring functions, in kChains sums each, so that enough of them are under
/// way; small terms come first, so that rounding acts on the last few.
template <int kCount, int kChains>
HWY_INLINE void sum_terms(const FitFunctionTables& t, int first, const float* values,
                          Pair* out) {
    const D d;
    const std::size_t step = 2 * hn::Lanes(d);
    Pair sum[kChains][kCount];
    for (int c = 0; c < kChains; ++c)
        for (int k = 0; k < kCount; ++k) sum[c][k] = both(0);
    const float* coefficient = t.coefficients.data() + first;
    const auto take = [&](int i, Pair(&to)[kCount]) HWY_ATTR {
        const Pair m = load(values + t.at[i] * step);
        for (int k = 0; k < kCount; ++k) {
            const V ck = constant(coefficient[i * t.count + k]);
            to[k] = {hn::MulAdd(ck, m.a, to[k].a), hn::MulAdd(ck, m.b, to[k].b)};
        }
    };
    int i = int(t.at.size()) - 1;
    for (; i >= kChains - 1; i -= kChains)
        for (int c = 0; c < kChains; ++c) take(i - c, sum[c]);
    for (; i >= 0; --i) take(i, sum[0]);
    for (int k = 0; k < kCount; ++k) {
        out[k] = sum[0][k];
        for (int c = 1; c < kChains; ++c) out[k] = add(out[k], sum[c][k]);
    }
}

HWY_INLINE void functions(const FitFunctionTables& t, const float* values, Pair* out) {
    int k = 0;
    for (; k + 4 <= t.count; k += 4) sum_terms<4, 1>(t, k, values, out + k);
    if (t.count - k >= 2) sum_terms<2, 2>(t, k, values, out + k), k += 2;
    if (t.count - k == 1) sum_terms<1, 4>(t, k, values, out + k);
}

HWY_INLINE Pair light(const FitLightTables& t, Pair l, const float* values) {
    Pair value = both(0);
    for (const FitFunctionTables& power : t.powers) {
        Pair row;
        sum_terms<1, 2>(power, 0, values, &row);
        value = mul_add(value, l, row);
    }
    return value;
}

inline constexpr int kMostFunctions = 40;

/// The vectors of a block: f A + q B, or x and y apart.
HWY_INLINE void vectors(const FitBlockTables& block, bool axial, const float* values,
                        const PairVec& f, const PairVec& q, PairVec* out) {
    Pair x[kMostFunctions];
    functions(block.x, values, x);
    if (axial) {
        for (int i = 0; 2 * i < block.x.count; ++i) {
            out[i].x = mul_add(f.x, x[2 * i], mul(q.x, x[2 * i + 1]));
            out[i].y = mul_add(f.y, x[2 * i], mul(q.y, x[2 * i + 1]));
        }
        return;
    }
    Pair y[kMostFunctions];
    functions(block.y, values, y);
    for (int i = 0; i < block.x.count; ++i) out[i] = {x[i], y[i]};
}

HWY_INLINE void axial_variables(const PairVec& f, const PairVec& q, Pair u, Pair l,
                                Pair (&at)[5]) {
    const Pair w = dot(q, q);
    at[0] = dot(f, q), at[1] = sub(add(w, w), both(1)), at[2] = u, at[3] = l,
    at[4] = both(1);
}
HWY_INLINE void free_variables(const PairVec& f, const PairVec& q, Pair l,
                               Pair (&at)[5]) {
    at[0] = q.x, at[1] = q.y, at[2] = f.x, at[3] = f.y, at[4] = l;
}

HWY_INLINE PairVec pupil_point(const FitPupilTables& p, const PairVec& f,
                               const PairVec& m) {
    return {mul_add(f.x, both(p.film_x), mul_add(m.x, both(p.slope_x), both(p.shift_x))),
            mul_add(f.y, both(p.film_y), mul_add(m.y, both(p.slope_y), both(p.shift_y)))};
}
HWY_INLINE PairVec pupil_slope(const FitPupilTables& p, const PairVec& f,
                               const PairVec& q) {
    const auto slope = [](Pair f, Pair q, float by_film, float by_slope,
                          float shift) HWY_ATTR {
        return mul(sub(sub(q, both(shift)), mul(f, both(by_film))), both(1 / by_slope));
    };
    return {slope(f.x, q.x, p.film_x, p.slope_x, p.shift_x),
            slope(f.y, q.y, p.film_y, p.slope_y, p.shift_y)};
}

HWY_INLINE Pair wavelength_variable(const WavelengthScale& scale, Pair nm) {
    return each(
        [&](V v) HWY_ATTR {
            const V inv_um = hn::Div(constant(1e3f), v);
            return hn::MulAdd(hn::Mul(inv_um, inv_um), constant(scale.scale),
                              constant(scale.offset));
        },
        nm);
}

/// (-1)^n / (2n + first)!.
struct AngleCoefficients {
    float c[kMostAngleTerms];
    explicit constexpr AngleCoefficients(int first) : c{} {
        double term = first == 1 ? 1 : 0.5;
        for (int n = 0; n < kMostAngleTerms; ++n) {
            c[n] = float(term);
            term /= -double((2 * n + first + 1) * (2 * n + first + 2));
        }
    }
};

/// sin(x) / x (first 1) and (1 - cos(x)) / x^2 (first 2) of t = x^2.
template <int kFirst>
HWY_INLINE Pair angle_series(int terms, Pair t) {
    static constexpr AngleCoefficients k(kFirst);
    Pair sum = both(k.c[terms - 1]);
    for (int n = terms - 2; n >= 0; --n) sum = mul_add(sum, t, both(k.c[n]));
    return sum;
}

struct PairRay {
    Pair x, y, z, dx, dy, dz;
};

/// LensFit::scene_ray(): z from the first vertex.
HWY_INLINE PairRay scene_ray(const FitTables& fit, const PairVec& v, const PairVec& e) {
    const Pair t = dot(v, v);
    const Pair sine = angle_series<1>(fit.angle_terms, t),
               versine = angle_series<2>(fit.angle_terms, t);
    const Pair along = dot(e, v), back = mul(along, versine);
    PairRay r;
    r.dx = mul(v.x, sine), r.dy = mul(v.y, sine), r.dz = sub(mul(t, versine), both(1));
    r.x = sub(e.x, mul(v.x, back)), r.y = sub(e.y, mul(v.y, back));
    r.z = mul_add(along, sine, both(fit.pupil_z));
    const V c = constant(fit.front_curvature), zero = hn::Zero(D());
    const auto advance = [&](V& x, V& y, V& z, V dx, V dy, V dz) HWY_ATTR {
        const V pd = hn::MulAdd(x, dx, hn::MulAdd(y, dy, hn::Mul(z, dz)));
        const V pp = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
        const V b = hn::MulSub(c, pd, dz), k = hn::MulSub(c, pp, hn::Add(z, z));
        const V root = hn::NegMulAdd(c, k, hn::Mul(b, b));
        const V far = hn::Neg(hn::Div(k, hn::Add(b, hn::Sqrt(root))));
        const V go = hn::IfThenElseZero(hn::Gt(root, zero), far);
        x = hn::MulAdd(go, dx, x), y = hn::MulAdd(go, dy, y), z = hn::MulAdd(go, dz, z);
    };
    advance(r.x.a, r.y.a, r.z.a, r.dx.a, r.dy.a, r.dz.a);
    advance(r.x.b, r.y.b, r.z.b, r.dx.b, r.dy.b, r.dz.b);
    return r;
}

/// What a fit says of a film ray in units of film and pupil.
struct FitLanes {
    PairVec direction, offset, iris;
    PairVec mounts[kMostFunctions / 2];
    Pair light;
};

HWY_INLINE V choose(M mask, V yes, V no) {
    return hn::IfThenElse(mask, yes, no);
}

struct PairMask {
    M a, b;
};
HWY_INLINE void choose(const PairMask& m, const PairVec& from, PairVec& to) {
    to.x = {choose(m.a, from.x.a, to.x.a), choose(m.b, from.x.b, to.x.b)};
    to.y = {choose(m.a, from.y.a, to.y.a), choose(m.b, from.y.b, to.y.b)};
}

/// Of the rays of one segment, whatever segment they belong to.
HWY_INLINE void evaluate_segment(const FitTables& fit, const FitSegmentTables& s,
                                 const PairVec& f, const PairVec& q, Pair u, Pair l,
                                 bool all, float* values, FitLanes& out) {
    Pair at[5];
    if (fit.axial)
        axial_variables(f, q, mul_add(u, both(s.u_scale), both(s.u_offset)), l, at);
    else
        free_variables(f, q, l, at);
    run_program(s.program, all ? int(s.program.runs.size()) : s.ray_runs, at, values);
    PairVec rays[2];
    vectors(s.rays, fit.axial, values, f, q, rays);
    out.direction = rays[0], out.offset = rays[1];
    if (!all) return;
    PairVec points[kMostFunctions / 2];
    vectors(s.points, fit.axial, values, f, q, points);
    out.iris = points[0];
    for (std::size_t i = 0; i < fit.outer2.size(); ++i) out.mounts[i] = points[i + 1];
    out.light = light(s.light, l, values);
}

/// The segment of each ray; or that of all, if it is known. `all`: iris, mounts and light
/// too.
HWY_INLINE void evaluate_fit(const FitTables& fit, const FitSegmentTables* known,
                             const PairVec& f, const PairVec& q, Pair l, bool all,
                             float* values, FitLanes& out) {
    const Pair u = dot(f, f);
    evaluate_segment(fit, known ? *known : fit.segments[0], f, q, u, l, all, values, out);
    if (known) return;
    const D d;
    for (std::size_t k = 1; k < fit.segments.size(); ++k) {
        const FitSegmentTables& s = fit.segments[k];
        const V low = constant(s.u_low);
        const PairMask mine{hn::Ge(u.a, low), hn::Ge(u.b, low)};
        if (hn::AllFalse(d, hn::Or(mine.a, mine.b))) continue;
        FitLanes here;
        evaluate_segment(fit, s, f, q, u, l, all, values, here);
        choose(mine, here.direction, out.direction),
            choose(mine, here.offset, out.offset);
        if (!all) continue;
        choose(mine, here.iris, out.iris);
        for (std::size_t i = 0; i < fit.outer2.size(); ++i)
            choose(mine, here.mounts[i], out.mounts[i]);
        out.light = {choose(mine.a, here.light.a, out.light.a),
                     choose(mine.b, here.light.b, out.light.b)};
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
