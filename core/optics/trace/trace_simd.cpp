#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/trace/trace_simd.cpp"
#include "optics/trace/trace_simd.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "math/cancel.h"
#include "optics/trace/film_landing-inl.h"
#include "optics/trace/film_start-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

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
HWY_EXPORT(TargetName);

void trace_to_scene(const LensTables& lens, const FilmRays& in, SceneRays& out,
                    int count) {
    throw_if_cancelled();
    HWY_DYNAMIC_DISPATCH(ToScene)(lens, in, out, count);
}
void trace_to_film(const LensTables& lens, SceneRays& in, FilmRays& out, int count) {
    throw_if_cancelled();
    HWY_DYNAMIC_DISPATCH(ToFilm)(lens, in, out, count);
}
const char* simd_target_name() {
    return HWY_DYNAMIC_DISPATCH(TargetName)();
}

}  // namespace dg
#endif  // HWY_ONCE
