#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/expansion/lens_fit_simd.cpp"
#include "optics/expansion/lens_fit_simd.h"

#include <algorithm>

#include "hwy/foreach_target.h"  // IWYU pragma: keep; before all that is compiled again

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "optics/expansion/lens_fit-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Maximal iterations of the inverse; each gains at least two digits.
constexpr int kInverseRounds = 4;

HWY_INLINE PairVec load(const float* x, const float* y) {
    return {load(x), load(y)};
}

HWY_INLINE PairVec unit_film(const FitTables& fit, const PairVec& p) {
    return {mul(sub(p.x, both(fit.center_x)), both(1 / fit.half_x)),
            mul(sub(p.y, both(fit.center_y)), both(1 / fit.half_y))};
}

HWY_INLINE V open(const FitTables& fit, V fx, V fy, V qx, V qy) {
    const V one = constant(1);
    M ok = hn::Le(hn::MulAdd(qx, qx, hn::Mul(qy, qy)), one);
    if (fit.axial)
        ok = hn::And(ok, hn::Le(hn::MulAdd(fx, fx, hn::Mul(fy, fy)), one));
    else
        ok = hn::And(ok, hn::Le(hn::Max(hn::Abs(fx), hn::Abs(fy)), one));
    return hn::IfThenElseZero(ok, one);
}

/// Transmittance including iris, mounts and domain.
HWY_INLINE Pair passed(const FitTables& fit, const PairVec& f, const PairVec& q,
                       const FitLanes& v) {
    const V zero = hn::Zero(D());
    const auto one = [&](V fx, V fy, V qx, V qy, V ix, V iy, V light) HWY_ATTR {
        const V pass = hn::Mul(open(fit, fx, fy, qx, qy), hn::Max(light, zero));
        return fit.iris.radius > 0 ? hn::Mul(pass, iris_transmission(fit.iris, ix, iy))
                                   : pass;
    };
    Pair pass = {one(f.x.a, f.y.a, q.x.a, q.y.a, v.iris.x.a, v.iris.y.a, v.light.a),
                 one(f.x.b, f.y.b, q.x.b, q.y.b, v.iris.x.b, v.iris.y.b, v.light.b)};
    for (std::size_t i = 0; i < fit.outer2.size(); ++i) {
        const Pair r2 = dot(v.mounts[i], v.mounts[i]);
        const V outer = constant(fit.outer2[i]), inner = constant(fit.inner2[i]);
        const auto within = [&](V r, V p) HWY_ATTR {
            return hn::IfThenElseZero(hn::And(hn::Le(r, outer), hn::Ge(r, inner)), p);
        };
        pass = each(within, r2, pass);
    }
    return pass;
}

void FitToScene(const FitTables& fit, const FitSegmentTables& segment, const FilmRays& in,
                SceneRays& out, int count) {
    const int step = 2 * int(hn::Lanes(D()));
    for (int i = 0; i < count; i += step) {
        const PairVec f = unit_film(fit, load(in.x + i, in.y + i));
        const PairVec q = pupil_point(fit.pupil, f, load(in.mx + i, in.my + i));
        FitLanes v;
        evaluate_fit(fit, &segment, f, q, wavelength_variable(fit.scale, load(in.nm + i)),
                     true, v);
        const PairRay r = scene_ray(fit, v.direction, v.offset);
        store(r.x, out.x + i), store(r.y, out.y + i), store(r.z, out.z + i);
        store(r.dx, out.dx + i), store(r.dy, out.dy + i), store(r.dz, out.dz + i);
        store(passed(fit, f, q, v), out.pass + i);
        store(v.iris.x, out.iris_x + i), store(v.iris.y, out.iris_y + i);
    }
}

struct LaneDescription {
    V vx, vy, ex, ey;   // direction v and offset e
};

/// describe_ray() in lanes for rays toward the scene, z relative to the first vertex.
HWY_INLINE LaneDescription describe_lanes(const FitTables& fit, const LaneVec& from,
                                          const LaneVec& along_ray) {
    const auto& [x, y, z] = from;
    const auto& [dx, dy, dz] = along_ray;
    const D d;
    const V one = constant(1), z0 = hn::Sub(z, constant(fit.pupil_z));
    const V away = hn::Sub(one, dz);  // 1 + cos(theta)
    const V sine = hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)));
    const V h = hn::Div(sine, away);  // tan(theta / 2)
    const M small = hn::Lt(h, constant(1e-3f));
    const V series = hn::NegMulAdd(hn::Mul(h, h), constant(1.0f / 3), one);
    const V ratio = hn::IfThenElse(small, series,
                                   hn::Div(hn::Atan(d, h), hn::Max(h, constant(1e-6f))));
    const V stretch = hn::Div(hn::Add(ratio, ratio), away);  // theta / sin(theta)
    const V vx = hn::Mul(dx, stretch), vy = hn::Mul(dy, stretch);
    const V along = hn::MulAdd(x, dx, hn::MulAdd(y, dy, hn::Mul(z0, dz)));
    const V px = hn::NegMulAdd(along, dx, x), py = hn::NegMulAdd(along, dy, y),
            pz = hn::NegMulAdd(along, dz, z0);
    const V turn = hn::Div(pz, hn::Add(ratio, ratio));  // p.z tan(theta / 2) / theta
    return {vx, vy, hn::MulAdd(vx, turn, px), hn::MulAdd(vy, turn, py)};
}

/// Approximate inverse: f and q from v and e.
HWY_INLINE void guess(const FitTables& fit, const PairVec& v, const PairVec& e, Pair l,
                      PairVec (&fq)[2]) {
    const Pair unit = both(fit.inverse_direction);
    const PairVec g{mul(v.x, unit), mul(v.y, unit)},
        h = pupil_point(fit.inverse_pupil, g, e);
    LanePlace at;
    set_place(fit.axial, g, h, sub(mul(both(2), dot(g, g)), both(1)), l, at);
    vector(fit.inverse_film, fit.axial, at, fq[0]);
    vector(fit.inverse_pupil_point, fit.axial, at, fq[1]);
}

HWY_INLINE PairVec sum(const PairVec& p, const PairVec& q) {
    return {add(p.x, q.x), add(p.y, q.y)};
}
HWY_INLINE PairVec difference(const PairVec& p, const PairVec& q) {
    return {sub(p.x, q.x), sub(p.y, q.y)};
}

/// With the fitted inverse G and the fit F: z <- z + G(target) - G(F(z)). The fixed point is F(z) =
/// target for any G; the error of G determines only the rate of convergence.
HWY_INLINE void invert(const FitTables& fit, const PairVec& v, const PairVec& e, Pair l,
                       PairVec (&z)[2], FitLanes& there) {
    const FitSegmentTables* known = fit.segments.size() == 1 ? &fit.segments[0] : nullptr;
    PairVec start[2];
    guess(fit, v, e, l, start);
    z[0] = start[0], z[1] = start[1];
    for (int round = 0; round < kInverseRounds; ++round) {
        PairVec back[2];
        evaluate_fit(fit, known, z[0], z[1], l, false, there);
        guess(fit, there.direction, there.offset, l, back);
        for (int k = 0; k < 2; ++k) z[k] = sum(z[k], difference(start[k], back[k]));
    }
    evaluate_fit(fit, known, z[0], z[1], l, true, there);
}

/// Whether the iteration converged: direction (rad) and offset (mm) match the target.
HWY_INLINE Pair arrived(const PairVec& v, const PairVec& e, const FitLanes& there,
                        Pair pass) {
    const PairVec dv = difference(there.direction, v), de = difference(there.offset, e);
    const auto close = [](V a, V b, V p) HWY_ATTR {
        const M ok = hn::And(hn::Lt(a, constant(1e-10f)), hn::Lt(b, constant(1e-6f)));
        return hn::IfThenElseZero(ok, p);
    };
    const Pair a = dot(dv, dv), b = dot(de, de);
    return {close(a.a, b.a, pass.a), close(a.b, b.b, pass.b)};
}

void FitToFilm(const FitTables& fit, SceneRays& in, FilmRays& out, int count) {
    const int step = 2 * int(hn::Lanes(D()));
    for (int i = 0; i < count; i += step) {
        const Pair x = load(in.x + i), y = load(in.y + i), z = load(in.z + i),
                   dx = load(in.dx + i), dy = load(in.dy + i), dz = load(in.dz + i);
        const LaneDescription a = describe_lanes(fit, {x.a, y.a, z.a}, {dx.a, dy.a, dz.a}),
                              b = describe_lanes(fit, {x.b, y.b, z.b}, {dx.b, dy.b, dz.b});
        const PairVec v{{a.vx, b.vx}, {a.vy, b.vy}}, e{{a.ex, b.ex}, {a.ey, b.ey}};
        PairVec fq[2];
        FitLanes there;
        invert(fit, v, e, wavelength_variable(fit.scale, load(out.nm + i)), fq, there);
        const PairVec m = pupil_slope(fit.pupil, fq[0], fq[1]);
        store(mul_add(fq[0].x, both(fit.half_x), both(fit.center_x)), out.x + i);
        store(mul_add(fq[0].y, both(fit.half_y), both(fit.center_y)), out.y + i);
        store(m.x, out.mx + i), store(m.y, out.my + i);
        store(arrived(v, e, there, passed(fit, fq[0], fq[1], there)), in.pass + i);
        store(there.iris.x, in.iris_x + i), store(there.iris.y, in.iris_y + i);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {
namespace {

HWY_EXPORT(FitToScene);
HWY_EXPORT(FitToFilm);

/// Gathers rays of a batch. Fills the rest of the arrays with the last ray, so that kernels read no
/// uninitialized rays.
int pick(const FilmRays& from, const std::vector<int>& at, FilmRays& to) {
    for (int i = 0; i < kLensBatch; ++i) {
        const int k = at[std::min<std::size_t>(i, at.size() - 1)];
        to.x[i] = from.x[k], to.y[i] = from.y[k], to.mx[i] = from.mx[k],
        to.my[i] = from.my[k];
        to.nm[i] = from.nm[k];
    }
    return int(at.size());
}

void put_back(const SceneRays& from, const std::vector<int>& at, SceneRays& to) {
    for (std::size_t i = 0; i < at.size(); ++i) {
        const int k = at[i];
        to.x[k] = from.x[i], to.y[k] = from.y[i], to.z[k] = from.z[i];
        to.dx[k] = from.dx[i], to.dy[k] = from.dy[i], to.dz[k] = from.dz[i];
        to.pass[k] = from.pass[i], to.iris_x[k] = from.iris_x[i],
        to.iris_y[k] = from.iris_y[i];
    }
}

/// Indices of a batch's rays by segment.
std::vector<std::vector<int>> by_segment(const FitTables& fit, const FilmRays& in,
                                         int count) {
    std::vector<std::vector<int>> at(fit.segments.size());
    for (int i = 0; i < count; ++i) {
        const float fx = (in.x[i] - fit.center_x) / fit.half_x,
                    fy = (in.y[i] - fit.center_y) / fit.half_y;
        const float u = fx * fx + fy * fy;
        std::size_t k = 0;
        while (k + 1 < at.size() && u >= fit.segments[k + 1].u_low) ++k;
        at[k].push_back(i);
    }
    return at;
}

}  // namespace

void fit_to_scene(const FitTables& fit, const FilmRays& in, SceneRays& out, int count) {
    const auto kernel = HWY_DYNAMIC_DISPATCH(FitToScene);
    if (fit.segments.size() == 1) return kernel(fit, fit.segments[0], in, out, count);
    FilmRays film;
    SceneRays scene;
    const auto owned = by_segment(fit, in, count);
    for (std::size_t k = 0; k < owned.size(); ++k) {
        if (owned[k].empty()) continue;
        const int rays = pick(in, owned[k], film);
        kernel(fit, fit.segments[k], film, scene, rays);
        put_back(scene, owned[k], out);
    }
}
void fit_to_film(const FitTables& fit, SceneRays& in, FilmRays& out, int count) {
    HWY_DYNAMIC_DISPATCH(FitToFilm)(fit, in, out, count);
}

}  // namespace dg
#endif  // HWY_ONCE
