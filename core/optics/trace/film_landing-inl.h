// film_landing-inl.h -- loads rays of the scene into SIMD lanes and intersects them with the film
// behind the last surface. Included once per instruction set.
#if defined(DG_OPTICS_FILM_LANDING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_FILM_LANDING_INL_H_
#undef DG_OPTICS_FILM_LANDING_INL_H_
#else
#define DG_OPTICS_FILM_LANDING_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/trace/trace-inl.h"
#include "optics/trace/trace_simd.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

HWY_INLINE V dot3(const float (&a)[3], V x, V y, V z) {
    return hn::MulAdd(constant(a[0]), x,
                      hn::MulAdd(constant(a[1]), y, hn::Mul(constant(a[2]), z)));
}

/// Intersects rays of slopes (mx, my) with a tilted film. r.z is relative to the last vertex; (x,
/// y) are film coordinates; `toward` is true for rays that approach the film.
HWY_INLINE void lens_to_film(const LensTables& lens, const LaneRays& r, V mx, V my, V& x, V& y,
                             M& toward) {
    const FilmPlaneTables& f = lens.film;
    const V one = constant(1), px = hn::Sub(r.x, constant(f.center_x)),
            py = hn::Sub(r.y, constant(f.center_y)), pz = hn::Sub(r.z, constant(lens.film_gap));
    const V along = dot3(f.normal, mx, my, one);
    const V go = hn::Neg(hn::Div(dot3(f.normal, px, py, pz), along));
    const V qx = hn::MulAdd(mx, go, px), qy = hn::MulAdd(my, go, py), qz = hn::Add(go, pz);
    x = dot3(f.x, qx, qy, qz), y = dot3(f.y, qx, qy, qz);
    toward = hn::Gt(along, hn::Zero(D()));
}

/// Loads rays of the scene into lanes. Directions of `in` point to the scene; wavelengths are in
/// `out`.
HWY_INLINE void start_in_scene(const LensTables& lens, const SceneRays& in, const FilmRays& out, int at,
                               LaneRays& r) {
    const D d;
    r.x = hn::Load(d, in.x + at), r.y = hn::Load(d, in.y + at), r.z = hn::Load(d, in.z + at);
    r.dx = hn::Neg(hn::Load(d, in.dx + at));
    r.dy = hn::Neg(hn::Load(d, in.dy + at));
    r.dz = hn::Neg(hn::Load(d, in.dz + at));
    r.iris_x = r.iris_y = hn::Zero(d);
    r.alive = hn::Eq(r.x, r.x);
    set_wavelength(lens, hn::Load(d, out.nm + at), r);
}

/// Propagates rays from the last surface to the film; clipped rays and rays that miss it get
/// transmittance 0.
HWY_INLINE void land_on_film(const LensTables& lens, const LaneRays& r, SceneRays& in, FilmRays& out, int at) {
    const D d;
    const V inv = hn::Div(constant(1), r.dz);
    const V mx = hn::Mul(r.dx, inv), my = hn::Mul(r.dy, inv);
    const V go = hn::Sub(constant(lens.film_gap), r.z);
    V x = hn::MulAdd(mx, go, r.x), y = hn::MulAdd(my, go, r.y);
    M ok = hn::And(r.alive, hn::Gt(r.dz, hn::Zero(d)));
    if (!lens.film.across) {
        M toward;
        lens_to_film(lens, r, mx, my, x, y, toward);
        ok = hn::And(ok, toward);
    }
    hn::Store(x, d, out.x + at), hn::Store(y, d, out.y + at);
    hn::Store(mx, d, out.mx + at), hn::Store(my, d, out.my + at);
    hn::Store(hn::IfThenElseZero(ok, r.transmittance), d, in.pass + at);
    hn::Store(r.iris_x, d, in.iris_x + at), hn::Store(r.iris_y, d, in.iris_y + at);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
