// Sizeless vectors (SVE, RVV) cannot be members of structs; on Arm NEON serves.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/trace_simd.cpp"
#include "optics/trace_simd.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "optics/film_landing-inl.h"
#include "optics/free_pupil-inl.h"
#include "optics/pupil-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// A point of a tilted film in the lens frame, z from the film's centre.
HWY_INLINE void film_to_lens(const FilmTables& f, V x, V y, LaneRays& r) {
    r.x = hn::MulAdd(x, constant(f.x[0]), hn::MulAdd(y, constant(f.y[0]), constant(f.center_x)));
    r.y = hn::MulAdd(x, constant(f.x[1]), hn::MulAdd(y, constant(f.y[1]), constant(f.center_y)));
    r.z = hn::MulAdd(x, constant(f.x[2]), hn::Mul(y, constant(f.y[2])));
}

/// Film rays into lanes: unit directions toward the scene.
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

void ToScene(const LensTables& lens, const FilmRays& in, SceneRays& out, int count) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    for (int i = 0; i < count; i += 2 * lanes) {
        LaneRays r[2];
        for (int h = 0; h < 2; ++h) {
            const int at = i + h * lanes;
            start_on_film(lens, hn::Load(d, in.x + at), hn::Load(d, in.y + at),
                          hn::Load(d, in.mx + at), hn::Load(d, in.my + at),
                          hn::Load(d, in.nm + at), r[h]);
        }
        lanes_to_scene(lens, r[0], r[1]);
        for (int h = 0; h < 2; ++h) store_scene_rays(r[h], out, i + h * lanes);
    }
}

void ToFilm(const LensTables& lens, SceneRays& in, FilmRays& out, int count) {
    const int lanes = int(hn::Lanes(D()));
    for (int i = 0; i < count; i += 2 * lanes) {
        LaneRays r[2];
        for (int h = 0; h < 2; ++h) start_in_scene(lens, in, out, i + h * lanes, r[h]);
        lanes_to_film(lens, r[0], r[1]);
        for (int h = 0; h < 2; ++h) land_on_film(lens, r[h], in, out, i + h * lanes);
    }
}

HWY_INLINE LaneAim aimed(const LensTables& lens, const AimTables& aim, V x, V y, V u, V v, V l) {
    return aim.free.degree > 0 ? draw_free_lanes(lens, aim, x, y, u, v, l)
                               : draw_lanes(lens, aim, x, y, u, v, l);
}

void Guided(const LensTables& lens, const AimTables& aim, const LensSamples& in,
            SceneRays& out, float* weight, FilmRays* slopes, int count) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    for (int i = 0; i < count; i += 2 * lanes) {
        LaneRays r[2];
        for (int h = 0; h < 2; ++h) {
            const int at = i + h * lanes;
            const V x = hn::Load(d, in.x + at), y = hn::Load(d, in.y + at);
            const V nm = hn::Load(d, in.nm + at);
            LaneRays scale;
            set_wavelength(lens, nm, scale);
            const V u = hn::Load(d, in.u + at), v = hn::Load(d, in.v + at);
            const LaneAim m = aimed(lens, aim, x, y, u, v, scale.l);
            start_on_film(lens, x, y, m.mx, m.my, nm, r[h]);
            hn::Store(m.weight, d, weight + at);
            if (slopes) {
                hn::Store(m.mx, d, slopes->mx + at), hn::Store(m.my, d, slopes->my + at);
                hn::Store(x, d, slopes->x + at), hn::Store(y, d, slopes->y + at);
                hn::Store(nm, d, slopes->nm + at);
            }
        }
        lanes_to_scene(lens, r[0], r[1]);
        for (int h = 0; h < 2; ++h) store_scene_rays(r[h], out, i + h * lanes);
    }
}

void Drawn(const LensTables& lens, const AimTables& aim, const LensSamples& in, FilmRays& out,
           float* weight, int count) {
    const D d;
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
        const V x = hn::Load(d, in.x + i), y = hn::Load(d, in.y + i), nm = hn::Load(d, in.nm + i);
        LaneRays scale;
        set_wavelength(lens, nm, scale);
        const LaneAim m = aimed(lens, aim, x, y, hn::Load(d, in.u + i), hn::Load(d, in.v + i), scale.l);
        hn::Store(x, d, out.x + i), hn::Store(y, d, out.y + i), hn::Store(nm, d, out.nm + i);
        hn::Store(m.mx, d, out.mx + i), hn::Store(m.my, d, out.my + i);
        hn::Store(m.weight, d, weight + i);
    }
}

void Weights(const LensTables& lens, const AimTables& aim, const FilmRays& rays,
             const SceneRays& traced, float* weight, int count) {
    const D d;
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
        LaneRays scale;
        set_wavelength(lens, hn::Load(d, rays.nm + i), scale);
        const V x = hn::Load(d, rays.x + i), y = hn::Load(d, rays.y + i),
                mx = hn::Load(d, rays.mx + i), my = hn::Load(d, rays.my + i),
                qx = hn::Load(d, traced.iris_x + i), qy = hn::Load(d, traced.iris_y + i);
        const V w = aim.free.degree > 0
                        ? weight_free_lanes(aim, x, y, mx, my, qx, qy, scale.l)
                        : weight_lanes(aim, x, y, mx, my, qx, qy, scale.l);
        const M ok = hn::Gt(hn::Load(d, traced.pass + i), hn::Zero(d));
        hn::Store(hn::IfThenElseZero(ok, w), d, weight + i);
    }
}

void Slopes(const LensTables& lens, const AimTables& aim, const LensSamples& in,
            FilmRays& out, float* j, int count) {
    const D d;
    const V to_unit = constant(1 / aim.iris_scale);
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
        LaneRays scale;
        const V nm = hn::Load(d, in.nm + i), x = hn::Load(d, in.x + i),
                y = hn::Load(d, in.y + i);
        set_wavelength(lens, nm, scale);
        const V ax = hn::Mul(to_unit, hn::Load(d, in.u + i)),
                ay = hn::Mul(to_unit, hn::Load(d, in.v + i));
        hn::Store(x, d, out.x + i), hn::Store(y, d, out.y + i),
            hn::Store(nm, d, out.nm + i);
        if (aim.free.degree > 0) {
            const LaneSlope s = free_slope_at(aim.free, free_film(aim.free, x, y), ax, ay, scale.l);
            hn::Store(s.mx, d, out.mx + i), hn::Store(s.my, d, out.my + i);
            hn::Store(jacobian(s), d, j + i);
            continue;
        }
        const Meridian f = meridian_of(aim, x, y);
        const LaneSlope s = slope_at(aim, f.r, ax, ay, scale.l);
        hn::Store(hn::MulSub(s.mx, f.ex, hn::Mul(s.my, f.ey)), d, out.mx + i);
        hn::Store(hn::MulAdd(s.mx, f.ey, hn::Mul(s.my, f.ex)), d, out.my + i);
        hn::Store(jacobian(s), d, j + i);
    }
}

const char* TargetName() {
    return hwy::TargetName(HWY_TARGET);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {

HWY_EXPORT(ToScene);
HWY_EXPORT(ToFilm);
HWY_EXPORT(Guided);
HWY_EXPORT(Drawn);
HWY_EXPORT(Weights);
HWY_EXPORT(Slopes);
HWY_EXPORT(TargetName);

void trace_to_scene(const LensTables& lens, const FilmRays& in, SceneRays& out,
                    int count) {
    HWY_DYNAMIC_DISPATCH(ToScene)(lens, in, out, count);
}
void trace_to_film(const LensTables& lens, SceneRays& in, FilmRays& out, int count) {
    HWY_DYNAMIC_DISPATCH(ToFilm)(lens, in, out, count);
}
void guided_rays(const LensTables& lens, const AimTables& aim, const LensSamples& in,
                 SceneRays& out, float* aim_weight, FilmRays* slopes, int count) {
    HWY_DYNAMIC_DISPATCH(Guided)(lens, aim, in, out, aim_weight, slopes, count);
}
void aimed_rays(const LensTables& lens, const AimTables& aim, const LensSamples& in, FilmRays& out,
                float* aim_weight, int count) {
    HWY_DYNAMIC_DISPATCH(Drawn)(lens, aim, in, out, aim_weight, count);
}
void aim_weights(const LensTables& lens, const AimTables& aim, const FilmRays& rays,
                 const SceneRays& traced, float* aim_weight, int count) {
    HWY_DYNAMIC_DISPATCH(Weights)(lens, aim, rays, traced, aim_weight, count);
}
void aim_slopes(const LensTables& lens, const AimTables& aim, const LensSamples& in,
                FilmRays& out, float* jacobian, int count) {
    HWY_DYNAMIC_DISPATCH(Slopes)(lens, aim, in, out, jacobian, count);
}
const char* simd_target_name() {
    return HWY_DYNAMIC_DISPATCH(TargetName)();
}

}  // namespace dg
#endif  // HWY_ONCE
