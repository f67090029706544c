#include "render/truth/ray_map.h"

#include <algorithm>
#include <limits>

#include "camera/mean_ray.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr int kSide = 24;   // lens samples along each axis
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Whether a ray through the lens at that time reaches a film point.
bool light_passes(const Camera& camera, Vec2d film_mm, float time) {
    std::vector<CameraSample> samples = lens_cells({float(film_mm.x), float(film_mm.y)}, kSide);
    for (CameraSample& sample : samples) sample.time = time;
    std::vector<CameraRay> rays(samples.size());
    generate_rays(camera, samples, rays);
    return std::ranges::any_of(rays, [](const CameraRay& ray) { return ray.weight > 0; });
}

}  // namespace

bool sees(const Camera& camera, const ChiefRays& chief, Vec2d film_mm, float time) {
    const ChiefRays::Lit lit = chief.lit(film_mm);
    if (lit != ChiefRays::Lit::unknown) return lit == ChiefRays::Lit::yes;
    return light_passes(camera, film_mm, time);
}

PixelRays ray_map(const Camera& camera, const Sensor& sensor, const Shutter& shutter,
                  const FilmLayout& region, RayFrame frame, int threads) {
    const std::size_t n = std::size_t(region.width) * region.height;
    const Vec3d none{kNone, kNone, kNone};
    PixelRays map{std::vector<Vec3d>(n, none), std::vector<Vec3d>(n, none), std::vector<double>(n)};
    const ChiefRaysOverTime chief(camera);
    parallel_tasks(threads, region.height, [&](std::int64_t row) {
        for (int x = 0; x < region.width; ++x) {
            const std::size_t i = std::size_t(row) * region.width + x;
            const Vec2d px{region.offset_x + x + 0.5, region.offset_y + double(row) + 0.5};
            const double time = map.times[i] = shutter.opens_at(px);
            const Vec2f moved = setting_at(camera, float(time)).film_shift_mm;
            const Vec2d film = sensor.mm_from_px(px) + Vec2d{moved.x, moved.y};
            chief.with_lens(float(time), [&](const ChiefRays& lens) {
                if (!sees(camera, lens, film, float(time))) return;
                const ChiefRay ray = lens.at(film);
                map.origins[i] = ray.origin, map.directions[i] = ray.direction;
            });
            if (frame == RayFrame::camera) continue;
            const Affine3d world = camera.world_from_camera.at(float(time));
            map.origins[i] = world.point(map.origins[i]);
            map.directions[i] = world.vector(map.directions[i]);
        }
    });
    return map;
}

}  // namespace dg
