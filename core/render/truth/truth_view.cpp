#include "render/truth/truth_view.h"

namespace dg {

TruthView::TruthView(const TruthFrame& frame, const RenderSettings& settings)
    : scene_(frame.scene),
      camera_(frame.camera),
      settings_(settings),
      chief_(frame.camera) {}

std::optional<Ray> TruthView::ray(Vec2d px) const {
    Ray ray;
    ray.time = time_at(px);
    const Vec2d film = settings_.sensor.mm_from_px(px) + shift(ray.time);
    const ChiefRay chief = chief_.with_lens(
        ray.time, [&](const ChiefRays& lens) { return lens.at(film); });
    if (chief.direction == Vec3d{0, 0, 0}) return std::nullopt;
    const Affine3d world = pose(ray.time);
    ray.origin = to_float(world.point(chief.origin));
    ray.direction = to_float(normalize(world.vector(chief.direction)));
    ray.t_min = float(camera_.near_clip.end(chief.origin, normalize(chief.direction)));
    if (!is_traceable(ray)) return std::nullopt;
    return ray;
}

std::optional<Vec2d> TruthView::px_of(Vec3d point, double w, float time) const {
    const Affine3d camera = inverse(pose(time));
    const Vec3d p = w != 0 ? camera.point(point) : camera.vector(point);
    const auto film = chief_.with_lens(
        time, [&](const ChiefRays& lens) { return lens.film_point(p, w); });
    if (!film) return std::nullopt;
    return settings_.sensor.px_from_mm(*film - shift(time));
}

std::optional<Vec2d> TruthView::px_of(const Seen& seen, float time) const {
    if (!seen.surface)
        return px_of(to_double(scene_.world_from_sky(seen.direction, time)), 0, time);
    const auto point = scene_.follow(seen.hit, seen.direction, time);
    return point ? px_of(*point, 1, time) : std::nullopt;
}

Vec2d TruthView::shift(float time) const {
    const Vec2f mm = setting_at(camera_, time).film_shift_mm;
    return {mm.x, mm.y};
}

}  // namespace dg
