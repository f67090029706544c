#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/aim/aim_simd.cpp"
#include "optics/aim/aim_simd.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "optics/aim/free_pupil-inl.h"
#include "optics/aim/pupil-inl.h"
#include "optics/trace/film_start-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

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

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {

HWY_EXPORT(Guided);
HWY_EXPORT(Drawn);
HWY_EXPORT(Weights);
HWY_EXPORT(Slopes);

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

}  // namespace dg
#endif  // HWY_ONCE
