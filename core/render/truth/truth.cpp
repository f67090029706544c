#include "render/truth/truth.h"

#include <limits>

#include "render/parallel.h"
#include "render/truth/truth_view.h"

namespace dg {
namespace {

/// Calls use(pixel index) for all pixels of a region.
template <typename Use>
void for_each_pixel(const FilmLayout& region, const RenderSettings& settings,
                    const Use& use) {
    parallel_tasks(settings.threads, region.height, [&](std::int64_t row) {
        for (int x = 0; x < region.width; ++x) use(std::size_t(row) * region.width + x);
    });
}

void note_surface(Truth& truth, std::size_t i, const TruthPoint& point) {
    truth.depth[i] = point.depth;
    truth.distance[i] = point.distance;
    truth.position[i] = point.position;
    truth.normal[i] = truth.seen[i].direction = point.normal;
    truth.object_id[i] = point.object_id;
    truth.material_id[i] = point.material_id;
}

}  // namespace

TruthPlanes::TruthPlanes(const FilmLayout& region) : region(region) {
    const std::size_t n = std::size_t(region.width) * region.height;
    depth.resize(n), distance.resize(n), position.resize(n), normal.resize(n);
    object_id.resize(n), material_id.resize(n);
}

Truth::Truth(const FilmLayout& region) : TruthPlanes(region), seen(depth.size()) {}

TruthPoint truth_point(const Scene& scene, const Ray& ray, const RawHit& hit,
                       const Affine3d& camera) {
    const Scene::Hit found = scene.surface(ray, hit);
    const SurfaceHit& s = found.surface;
    const Vec3d from_camera = to_double(s.position) - camera.origin;
    TruthPoint point{float(-dot(from_camera, camera.z)), float(length(from_camera)),
                     s.position, s.ns};
    if (found.sphere_light >= 0) return point;
    point.object_id = s.instance + 1;
    point.material_id = scene.description().instances[s.instance].material + 1;
    return point;
}

Truth see(const TruthFrame& frame, const FilmLayout& region,
          const RenderSettings& settings) {
    Truth truth(region);
    const TruthView view(frame, settings);
    for_each_pixel(region, settings, [&](std::size_t i) {
        const std::optional<Ray> ray = view.ray(centre(region, i));
        if (!ray) return;
        const auto hit = frame.scene.first_hit(*ray);
        truth.seen[i] = {hit.value_or(RawHit{}), hit.has_value(),
                         frame.scene.sky_from_world(ray->direction, ray->time)};
        if (!hit) return;
        note_surface(truth, i, truth_point(frame.scene, *ray, *hit, view.pose(ray->time)));
    });
    return truth;
}

std::vector<Vec2d> places(const Truth& truth, const TruthFrame& frame,
                          const RenderSettings& settings) {
    std::vector<Vec2d> px(truth.seen.size());
    const TruthView view(frame, settings);
    for_each_pixel(truth.region, settings, [&](std::size_t i) {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        px[i] = view.landing(truth.seen[i], centre(truth.region, i))
                    .value_or(Vec2d{kNone, kNone});
    });
    return px;
}

}  // namespace dg
