// lens_fit-inl.h -- polynomials of a fitted lens in SIMD lanes. Included once per instruction set.
#if defined(DG_OPTICS_LENS_FIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_LENS_FIT_INL_H_
#undef DG_OPTICS_LENS_FIT_INL_H_
#else
#define DG_OPTICS_LENS_FIT_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/expansion/lens_fit_simd.h"
#include "optics/trace/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Two vectors of rays, evaluated together to hide the latency of dependent operations.
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

/// Evaluation point: two vectors, the variables of the basis and, without axial symmetry, their
/// squares.
struct LanePlace {
    PairVec f, q;
    Pair x[5], square[5];
};

inline constexpr int kLastAxial = 3, kLastFree = 4;  // index of the last variable

/// Evaluates a node of a Horner scheme and its subtree, for `kCount` functions at once.
template <int kVariable, int kLast, int kCount>
HWY_INLINE void horner(const int*& node, const float*& c, const LanePlace& at,
                       Pair (&out)[kCount]) {
    constexpr bool kParities = kLast == kLastFree;  // axial schemes have none
    const int code = *node++;
    const Pair x = kParities && code >= kFitEven ? at.square[kVariable] : at.x[kVariable];
    int more = kParities ? code & (kFitEven - 1) : code;
    if constexpr (kVariable == kLast) {
        for (int k = 0; k < kCount; ++k) out[k] = both(*c++);
        while (--more > 0)
            for (int k = 0; k < kCount; ++k) out[k] = mul_add(out[k], x, both(*c++));
    } else {
        horner<kVariable + 1, kLast>(node, c, at, out);
        while (--more > 0) {
            Pair below[kCount];
            horner<kVariable + 1, kLast>(node, c, at, below);
            for (int k = 0; k < kCount; ++k) out[k] = mul_add(out[k], x, below[k]);
        }
    }
    if (kParities && code >= kFitOdd)
        for (int k = 0; k < kCount; ++k) out[k] = mul(out[k], at.x[kVariable]);
}

template <int kLast, int kCount>
HWY_INLINE void functions(const FitHorner& h, const LanePlace& at, Pair (&out)[kCount]) {
    const int* node = h.nodes.data();
    const float* c = h.coefficients.data();
    horner<0, kLast>(node, c, at, out);
}

// Not inlined, and with arguments in memory, so that callers need not save registers.

HWY_NOINLINE void number(const FitHorner& h, bool axial, const LanePlace& at, Pair& out) {
    Pair one[1];
    if (axial)
        functions<kLastAxial, 1>(h, at, one);
    else
        functions<kLastFree, 1>(h, at, one);
    out = one[0];
}

/// Vector f A + q B, or separate polynomials for x and y.
HWY_NOINLINE void vector(const FitVectorTables& v, bool axial, const LanePlace& at,
                         PairVec& out) {
    if (!axial) {
        number(v.x, false, at, out.x), number(v.y, false, at, out.y);
        return;
    }
    Pair ab[2];
    functions<kLastAxial, 2>(v.x, at, ab);
    out.x = mul_add(at.f.x, ab[0], mul(at.q.x, ab[1]));
    out.y = mul_add(at.f.y, ab[0], mul(at.q.y, ab[1]));
}

inline constexpr int kMostMounts = 16;  // check_lens_fit()

HWY_INLINE Pair number(const FitHorner& h, bool axial, const LanePlace& at) {
    Pair one[1];
    if (axial)
        functions<kLastAxial, 1>(h, at, one);
    else
        functions<kLastFree, 1>(h, at, one);
    return one[0];
}

/// Vector f A + q B, or separate polynomials for x and y.
HWY_INLINE PairVec vector(const FitVectorTables& v, bool axial, const LanePlace& at,
                          const PairVec& f, const PairVec& q) {
    if (!axial) return {number(v.x, false, at), number(v.y, false, at)};
    Pair ab[2];
    functions<kLastAxial, 2>(v.x, at, ab);
    return {mul_add(f.x, ab[0], mul(q.x, ab[1])), mul_add(f.y, ab[0], mul(q.y, ab[1]))};
}

/// Initializes an evaluation point; u is the mapped variable U of the basis.
HWY_INLINE void set_place(bool axial, const PairVec& f, const PairVec& q, Pair u, Pair l,
                          LanePlace& at) {
    at.f = f, at.q = q;
    if (axial) {
        const Pair w = dot(q, q);
        at.x[0] = dot(f, q), at.x[1] = sub(add(w, w), both(1)), at.x[2] = u, at.x[3] = l;
        return;
    }
    at.x[0] = q.x, at.x[1] = q.y, at.x[2] = f.x, at.x[3] = f.y, at.x[4] = l;
    for (int k = 0; k < 5; ++k) at.square[k] = mul(at.x[k], at.x[k]);
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

/// Coefficients (-1)^n / (2n + first)!.
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

/// sin(x) / x (kFirst 1) or (1 - cos(x)) / x^2 (kFirst 2) as a series in t = x^2.
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

/// LensFit::scene_ray() in lanes; z is relative to the first vertex.
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

/// Evaluated fit for film rays in unit coordinates of film and pupil.
struct FitLanes {
    PairVec direction, offset, iris;
    PairVec mounts[kMostMounts];
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

/// Evaluates all rays with the polynomials of one segment, including rays outside of it.
HWY_INLINE void evaluate_segment(const FitTables& fit, const FitSegmentTables& s,
                                 const PairVec& f, const PairVec& q, Pair u, Pair l,
                                 bool all, FitLanes& out) {
    LanePlace at, bent;
    const Pair range = mul_add(u, both(s.u_scale), both(s.u_offset));
    set_place(fit.axial, f, q, range, l, at);
    PairVec bend{both(0), both(0)};
    if (s.bends) vector(s.bend, fit.axial, at, bend);
    vector(s.offset, fit.axial, at, out.offset);
    if (all) {
        vector(s.iris, fit.axial, at, out.iris);
        for (std::size_t i = 0; i < s.mounts.size(); ++i)
            vector(s.mounts[i], fit.axial, at, out.mounts[i]);
        number(s.light, fit.axial, at, out.light);
    }
    set_place(fit.axial, f, {add(q.x, bend.x), add(q.y, bend.y)}, range, l, bent);
    vector(s.direction, fit.axial, bent, out.direction);
}

/// Evaluates each ray with its segment, or all with the `known` segment. `all`: computes iris,
/// mounts and transmittance too.
HWY_INLINE void evaluate_fit(const FitTables& fit, const FitSegmentTables* known,
                             const PairVec& f, const PairVec& q, Pair l, bool all,
                             FitLanes& out) {
    const Pair u = dot(f, f);
    evaluate_segment(fit, known ? *known : fit.segments[0], f, q, u, l, all, out);
    if (known) return;
    const D d;
    for (std::size_t k = 1; k < fit.segments.size(); ++k) {
        const FitSegmentTables& s = fit.segments[k];
        const V low = constant(s.u_low);
        const PairMask mine{hn::Ge(u.a, low), hn::Ge(u.b, low)};
        if (hn::AllFalse(d, hn::Or(mine.a, mine.b))) continue;
        FitLanes here;
        evaluate_segment(fit, s, f, q, u, l, all, here);
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
