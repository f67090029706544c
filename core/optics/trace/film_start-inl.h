// film_start-inl.h -- loads film rays into SIMD lanes and stores scene rays from them. Included
// once per instruction set.
#if defined(DG_OPTICS_FILM_START_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_FILM_START_INL_H_
#undef DG_OPTICS_FILM_START_INL_H_
#else
#define DG_OPTICS_FILM_START_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/trace/trace-inl.h"
#include "optics/trace/trace_simd.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Points of a tilted film in the lens frame; z is relative to the centre of the film.
HWY_INLINE void film_to_lens(const FilmPlaneTables& f, V x, V y, LaneRays& r) {
    r.x = hn::MulAdd(x, constant(f.x[0]), hn::MulAdd(y, constant(f.y[0]), constant(f.center_x)));
    r.y = hn::MulAdd(x, constant(f.x[1]), hn::MulAdd(y, constant(f.y[1]), constant(f.center_y)));
    r.z = hn::MulAdd(x, constant(f.x[2]), hn::Mul(y, constant(f.y[2])));
}

/// Loads film rays into lanes, with unit directions toward the scene.
HWY_INLINE void start_on_film(const LensTables& lens, V x, V y, V mx, V my, V nm,
                              LaneRays& r) {
    const V one = constant(1);
    const V inv = hn::Div(one, hn::Sqrt(hn::MulAdd(mx, mx, hn::MulAdd(my, my, one))));
    r.x = x, r.y = y, r.z = hn::Zero(D());
    if (!lens.film.across) film_to_lens(lens.film, x, y, r);
    r.dx = hn::Neg(hn::Mul(mx, inv)), r.dy = hn::Neg(hn::Mul(my, inv)),
    r.dz = hn::Neg(inv);
    set_wavelength(lens, nm, r);
    r.iris_x = r.iris_y = hn::Zero(D());
    r.alive = hn::Eq(one, one);
}

HWY_INLINE void store_scene_rays(const LaneRays& r, SceneRays& out, int i) {
    const D d;
    hn::Store(r.x, d, out.x + i), hn::Store(r.y, d, out.y + i),
        hn::Store(r.z, d, out.z + i);
    hn::Store(r.dx, d, out.dx + i), hn::Store(r.dy, d, out.dy + i),
        hn::Store(r.dz, d, out.dz + i);
    hn::Store(hn::IfThenElseZero(r.alive, r.transmittance), d, out.pass + i);
    hn::Store(r.iris_x, d, out.iris_x + i), hn::Store(r.iris_y, d, out.iris_y + i);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
