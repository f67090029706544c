// ghost_simd.cpp -- traces ghosts in SIMD lanes: trace_ghost (ghost_lens.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/stray/ghost_simd.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "optics/trace/film_landing-inl.h"
#include "optics/stray/ghost_step-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Reflection in Tracer::cross, after the intersection.
template <int kSign>
HWY_INLINE void reflect_at(const GhostLens& ghosts, int i, const LaneHit& hit, LaneRays& r) {
    const M ok = stop_at_surface<kSign>(ghosts.tables(), i, hit, r);
    turn_back<kSign>(ghosts, i, hit, r);
    r.alive = hn::And(r.alive, ok);
}

template <int kSign>
HWY_INLINE void take_step(const GhostLens& ghosts, const GhostStep& step, bool mirrored, LaneRays& a,
                          LaneRays& b) {
    const LensTables& lens = ghosts.tables();
    const int i = step.surface;
    LaneHit hit[2];
    meet_any<kSign>(lens, i, a, b, hit);
    if (mirrored) {
        hit[0].ok = hn::And(hit[0].ok, onward(a, hit[0]));
        hit[1].ok = hn::And(hit[1].ok, onward(b, hit[1]));
    }
    if (step.reflects) {
        reflect_at<kSign>(ghosts, i, hit[0], a), reflect_at<kSign>(ghosts, i, hit[1], b);
    } else {
        pass_surface<kSign>(lens, i, hit[0], a), pass_surface<kSign>(lens, i, hit[1], b);
    }
    if (lens.intersection[i] == Intersection::other && lens.shape[i].placed)
        leave_frame(lens.shape[i], a), leave_frame(lens.shape[i], b);
}

/// Applies a leaf shutter in the plane of the iris: the iris, scaled by the opening.
HWY_INLINE void pass_leaf(const LensTables& lens, V opening, LaneRays& r) {
    const V wide = hn::Div(constant(1), hn::Max(opening, constant(1e-6f)));
    const V open = iris_transmission(lens.iris, hn::Mul(r.iris_x, wide), hn::Mul(r.iris_y, wide));
    r.transmittance = hn::Mul(r.transmittance, hn::IfThenElse(hn::Ge(opening, constant(1)), constant(1), open));
    r.alive = hn::And(r.alive, hn::Gt(r.transmittance, hn::Zero(D())));
}

/// Traces a ghost path; returns false as soon as no ray is alive.
HWY_INLINE bool lanes_by_mirrors(const GhostLens& ghosts, const std::vector<GhostStep>& steps,
                                 const float* opening, LaneRays& a, LaneRays& b) {
    const LensTables& lens = ghosts.tables();
    const D d;
    a.n = index_of(lens, 0, a.l), b.n = index_of(lens, 0, b.l);
    start_transmittance(a), start_transmittance(b);
    bool mirrored = false;
    for (const GhostStep& step : steps) {
        const V gap = constant(step.gap);
        a.z = hn::Sub(a.z, gap), b.z = hn::Sub(b.z, gap);
        step.sign > 0 ? take_step<1>(ghosts, step, mirrored, a, b) : take_step<-1>(ghosts, step, mirrored, a, b);
        mirrored = step.reflects;
        if (opening && step.surface == lens.stop) {
            pass_leaf(lens, hn::Load(d, opening), a);
            pass_leaf(lens, hn::Load(d, opening + hn::Lanes(d)), b);
        }
        if (hn::AllFalse(d, hn::Or(a.alive, b.alive))) return false;
    }
    finish_transmittance(lens, a), finish_transmittance(lens, b);
    return true;
}

void Ghost(const GhostLens& ghosts, const std::vector<GhostStep>& steps, SceneRays& in, FilmRays& out,
           const float* opening, int count) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    for (int i = 0; i < count; i += 2 * lanes) {
        LaneRays r[2];
        for (int h = 0; h < 2; ++h) start_in_scene(ghosts.tables(), in, out, i + h * lanes, r[h]);
        if (lanes_by_mirrors(ghosts, steps, opening ? opening + i : nullptr, r[0], r[1])) {
            for (int h = 0; h < 2; ++h) land_on_film(ghosts.tables(), r[h], in, out, i + h * lanes);
        } else {
            for (int h = 0; h < 2; ++h) hn::Store(hn::Zero(d), d, in.pass + i + h * lanes);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {

HWY_EXPORT(Ghost);

void trace_ghost(const GhostLens& lens, const std::vector<GhostStep>& steps, SceneRays& in, FilmRays& out,
                 const float* iris_opening, int count) {
    HWY_DYNAMIC_DISPATCH(Ghost)(lens, steps, in, out, iris_opening, count);
}

}  // namespace dg
#endif  // HWY_ONCE
