// ghost_step-inl.h -- steps of ghost rays in SIMD lanes: intersection with a surface, and
// reflection. Included once per instruction set.
#if defined(DG_OPTICS_GHOST_STEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_GHOST_STEP_INL_H_
#undef DG_OPTICS_GHOST_STEP_INL_H_
#else
#define DG_OPTICS_GHOST_STEP_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/stray/reflection-inl.h"
#include "optics/trace/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Reflects rays at a surface that they have hit.
template <int kSign>
HWY_INLINE void turn_back(const GhostLens& ghosts, int i, const LaneHit& hit, LaneRays& r) {
    const LensTables& lens = ghosts.tables();
    const V n2 = index_of(lens, kSign > 0 ? i + 1 : i, r.l);
    const V mu = hn::Div(r.n, n2), one = constant(1);
    const V squared = hn::NegMulAdd(hn::Mul(mu, mu), hn::Sub(one, hit.cos1_squared), one);
    const V cos2 = hn::Sqrt(hn::Max(squared, hn::Zero(D())));
    const MirrorTables& mirror = ghosts.mirrors()[i];
    const LaneCrossing at{r.n, hit.cos1, n2, cos2, r.l};
    r.transmittance = hn::Mul(r.transmittance, reflectance_lanes(lens, mirror, at, squared,
                                                                 mirror.rarer_in_front == (kSign > 0)));
    const V turn = signed_by<kSign>(hn::Add(hit.cos1, hit.cos1));
    r.dx = hn::MulAdd(hn::Mul(turn, hit.bend_x), hit.point.x, r.dx);
    r.dy = hn::MulAdd(hn::Mul(turn, hit.bend_y), hit.point.y, r.dy);
    r.dz = hn::NegMulAdd(turn, hit.axial, r.dz);
}

/// Intersects two vectors of rays with a surface; leaves the rays in the surface's frame.
template <int kSign>
HWY_INLINE void meet_any(const LensTables& lens, int i, LaneRays& a, LaneRays& b, LaneHit (&hit)[2]) {
    const LaneVec pa{a.x, a.y, a.z}, da{a.dx, a.dy, a.dz}, pb{b.x, b.y, b.z}, db{b.dx, b.dy, b.dz};
    switch (lens.intersection[i]) {
        case Intersection::plane:
            hit[0] = meet_plane<kSign>(pa, da), hit[1] = meet_plane<kSign>(pb, db);
            return;
        case Intersection::sphere:
            hit[0] = meet_sphere<kSign>(lens.curvature[i], pa, da);
            hit[1] = meet_sphere<kSign>(lens.curvature[i], pb, db);
            return;
        default:
            meet_other<kSign>(lens, i, a, b, hit);
    }
}

constexpr float kOverlap = 0.01f;  // mm, as in Tracer::follow

/// Whether rays move forward to their hit: a steep mirror may send light away from the next
/// surface.
HWY_INLINE M onward(const LaneRays& r, const LaneHit& hit) {
    const V way = hn::MulAdd(hn::Sub(hit.point.x, r.x), r.dx,
                             hn::MulAdd(hn::Sub(hit.point.y, r.y), r.dy,
                                        hn::Mul(hn::Sub(hit.point.z, r.z), r.dz)));
    return hn::Ge(way, constant(-kOverlap));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
