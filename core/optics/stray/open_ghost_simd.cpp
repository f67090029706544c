// open_ghost_simd.cpp -- traces unclipped ghost rays in SIMD lanes: trace_open_ghost
// (open_ghost.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/stray/open_ghost_simd.cpp"
#include <cmath>

#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "math/error.h"
#include "optics/stray/open_ghost.h"
#include "optics/stray/ghost_step-inl.h"
#include "optics/trace/film_landing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

constexpr float kLost = 0.05f;   // least `beyond` of a lost ray

struct OpenLanes {
    LaneRays r;
    V beyond, ways, lost_after;   // ways: steps done
    V iris_x[kMostCrossings], iris_y[kMostCrossings];
};

/// Updates the maximal distance beyond an aperture for rays that are not lost.
HWY_INLINE void record(OpenLanes& o, V beyond) {
    o.beyond = hn::IfThenElse(o.r.alive, hn::Max(o.beyond, beyond), o.beyond);
}

/// Marks rays that fail `ok` as lost; `by`: their distance beyond.
HWY_INLINE void lose(OpenLanes& o, M ok, V by) {
    const M lost = hn::AndNot(ok, o.r.alive);
    o.beyond = hn::IfThenElse(lost, hn::Max(o.beyond, hn::Max(by, constant(kLost))), o.beyond);
    o.lost_after = hn::IfThenElse(lost, o.ways, o.lost_after);
    o.r.alive = hn::And(o.r.alive, ok);
}

/// Refracts rays by Snell's law; total reflection loses them.
template <int kSign>
HWY_INLINE void bend(const LensTables& lens, int i, const LaneHit& hit, OpenLanes& o) {
    LaneRays& r = o.r;
    const V one = constant(1), n2 = index_of(lens, kSign > 0 ? i + 1 : i, r.l);
    if (lens.refracts[i]) {
        const V mu = hn::Div(r.n, n2);
        const V squared = hn::NegMulAdd(hn::Mul(mu, mu), hn::Sub(one, hit.cos1_squared), one);
        lose(o, hn::Ge(squared, hn::Zero(D())), hn::Neg(squared));
        const V cos2 = hn::Sqrt(hn::Max(squared, hn::Zero(D())));
        if (lens.fresnel[i] != FresnelModel::none) {
            const LaneCrossing at{r.n, hit.cos1, n2, cos2, r.l};
            r.transmittance = hn::Mul(r.transmittance, transmission_lanes<kSign>(lens, i, at));
        }
        const V g = signed_by<kSign>(hn::NegMulAdd(mu, hit.cos1, cos2));
        r.dx = hn::NegMulAdd(hn::Mul(g, hit.bend_x), hit.point.x, hn::Mul(mu, r.dx));
        r.dy = hn::NegMulAdd(hn::Mul(g, hit.bend_y), hit.point.y, hn::Mul(mu, r.dy));
        r.dz = hn::MulAdd(g, hit.axial, hn::Mul(mu, r.dz));
    }
    r.n = n2;
}

/// Intersects a surface, records its apertures, and refracts or reflects. `crossing`: index of the
/// iris crossing, should this surface be the stop.
template <int kSign>
HWY_INLINE void open_step(const GhostLens& ghosts, const GhostStep& step, bool mirrored, int crossing,
                          const LaneHit& hit, OpenLanes& o) {
    const LensTables& lens = ghosts.tables();
    const int i = step.surface;
    lose(o, hit.ok, hn::Neg(hit.cos1_squared));
    if (mirrored) lose(o, onward(o.r, hit), constant(kLost));
    swallow(lens, kSign > 0 ? i : i + 1, hit.point, o.r);
    o.r.x = hit.point.x, o.r.y = hit.point.y, o.r.z = hit.point.z;
    const V r2 = hn::MulAdd(o.r.x, o.r.x, hn::Mul(o.r.y, o.r.y));
    if (std::isfinite(lens.semi2[i])) record(o, hn::MulSub(r2, constant(1 / lens.semi2[i]), constant(1)));
    if (lens.inner2[i] > 0) record(o, hn::NegMulAdd(r2, constant(1 / lens.inner2[i]), constant(1)));
    if (i == lens.stop) o.iris_x[crossing] = o.r.x, o.iris_y[crossing] = o.r.y;
    step.reflects ? turn_back<kSign>(ghosts, i, hit, o.r) : bend<kSign>(lens, i, hit, o);
}

template <int kSign>
HWY_INLINE void open_steps(const GhostLens& ghosts, const GhostStep& step, bool mirrored, int crossing,
                           OpenLanes& a, OpenLanes& b) {
    const LensTables& lens = ghosts.tables();
    LaneHit hit[2];
    meet_any<kSign>(lens, step.surface, a.r, b.r, hit);
    open_step<kSign>(ghosts, step, mirrored, crossing, hit[0], a);
    open_step<kSign>(ghosts, step, mirrored, crossing, hit[1], b);
    if (lens.intersection[step.surface] == Intersection::other && lens.shape[step.surface].placed)
        leave_frame(lens.shape[step.surface], a.r), leave_frame(lens.shape[step.surface], b.r);
}

HWY_INLINE void begin(const GhostLens& ghosts, const SceneRays& in, const FilmRays& nm, int at, OpenLanes& o) {
    start_in_scene(ghosts.tables(), in, nm, at, o.r);
    o.r.n = index_of(ghosts.tables(), 0, o.r.l);
    start_transmittance(o.r);
    o.beyond = constant(-1);
    o.ways = o.lost_after = hn::Zero(D());
    for (int k = 0; k < kMostCrossings; ++k) o.iris_x[k] = o.iris_y[k] = hn::Zero(D());
}

HWY_INLINE void end(const GhostLens& ghosts, OpenLanes& o, OpenLandings& out, int at) {
    const D d;
    const LensTables& lens = ghosts.tables();
    finish_transmittance(lens, o.r);
    lose(o, hn::Gt(o.r.dz, hn::Zero(d)), constant(kLost));
    const V inv = hn::Div(constant(1), o.r.dz);
    const V mx = hn::Mul(o.r.dx, inv), my = hn::Mul(o.r.dy, inv), go = hn::Sub(constant(lens.film_gap), o.r.z);
    V x = hn::MulAdd(mx, go, o.r.x), y = hn::MulAdd(my, go, o.r.y);
    if (!lens.film.across) {
        M toward;
        lens_to_film(lens, o.r, mx, my, x, y, toward);
        lose(o, toward, constant(kLost));
    }
    const M sound = o.r.alive;
    hn::Store(hn::IfThenElseZero(sound, x), d, out.x + at);
    hn::Store(hn::IfThenElseZero(sound, y), d, out.y + at);
    hn::Store(o.beyond, d, out.beyond + at);
    hn::Store(o.lost_after, d, out.lost_after + at);
    hn::Store(hn::IfThenElseZero(sound, constant(1)), d, out.sound + at);
    hn::Store(hn::IfThenElseZero(sound, o.r.transmittance), d, out.pass + at);
    for (int k = 0; k < kMostCrossings; ++k) {
        hn::Store(hn::IfThenElseZero(sound, o.iris_x[k]), d, out.iris_x[k] + at);
        hn::Store(hn::IfThenElseZero(sound, o.iris_y[k]), d, out.iris_y[k] + at);
    }
}

void Open(const GhostLens& ghosts, const std::vector<GhostStep>& steps, const SceneRays& in, const FilmRays& nm,
          OpenLandings& out, int count) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    for (int i = 0; i < count; i += 2 * lanes) {
        OpenLanes a, b;
        begin(ghosts, in, nm, i, a), begin(ghosts, in, nm, i + lanes, b);
        bool mirrored = false;
        int crossing = 0;
        for (const GhostStep& step : steps) {
            const V gap = constant(step.gap);
            a.r.z = hn::Sub(a.r.z, gap), b.r.z = hn::Sub(b.r.z, gap);
            step.sign > 0 ? open_steps<1>(ghosts, step, mirrored, crossing, a, b)
                          : open_steps<-1>(ghosts, step, mirrored, crossing, a, b);
            mirrored = step.reflects;
            crossing += step.surface == ghosts.tables().stop;
            a.ways = b.ways = hn::Add(a.ways, constant(1));
            if (hn::AllFalse(d, hn::Or(a.r.alive, b.r.alive))) break;
        }
        end(ghosts, a, out, i), end(ghosts, b, out, i + lanes);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {

HWY_EXPORT(Open);

int crossings(const GhostLens& lens, const std::vector<GhostStep>& steps) {
    int count = 0;
    for (const GhostStep& step : steps) count += step.surface == lens.tables().stop;
    return count;
}

void trace_open_ghost(const GhostLens& lens, const std::vector<GhostStep>& steps, const SceneRays& in,
                      const FilmRays& nm, OpenLandings& out, int count) {
    DG_CHECK(crossings(lens, steps), <=, kMostCrossings);
    HWY_DYNAMIC_DISPATCH(Open)(lens, steps, in, nm, out, count);
}

}  // namespace dg
#endif  // HWY_ONCE
