#include "render/truth.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <limits>

#include "camera/chief.h"

namespace dg {
namespace {

constexpr int kRounds = 16;  // of the plain search for the line on which a point lands
constexpr double kSettled = 1e-5;  // px

/// One frame's camera, ready to be asked at any time.
class View {
  public:
    View(const TruthFrame& frame, const RenderSettings& settings)
        : scene_(frame.scene),
          camera_(frame.camera),
          settings_(settings),
          chief_(frame.camera) {}

    float time_at(Vec2d px) const { return float(settings_.shutter.opens_at(px)); }
    Affine3d pose(float time) const { return camera_.world_from_camera.at(time); }

    /// Nothing where the camera sees nothing.
    std::optional<Ray> ray(Vec2d px) const {
        Ray ray;
        ray.time = time_at(px);
        const Vec2d film = settings_.sensor.mm_from_px(px) + shift(ray.time);
        const ChiefRay chief = chief_.with_lens(
            ray.time, [&](const ChiefRays& lens) { return lens.at(film); });
        if (chief.direction == Vec3d{0, 0, 0}) return std::nullopt;
        const Affine3d world = pose(ray.time);
        ray.origin = to_float(world.point(chief.origin));
        ray.direction = to_float(normalize(world.vector(chief.direction)));
        return ray;
    }

    /// Where something that is seen lies on the film at `time`.
    std::optional<Vec2d> px_of(const Truth::Seen& seen, float time) const {
        const Affine3d camera = inverse(pose(time));
        std::optional<Vec3d> point;
        if (seen.surface) {
            point = scene_.follow(seen.hit, seen.direction, time);
            if (point) point = camera.point(*point);
        } else {
            point = camera.vector(to_double(scene_.world_from_sky(seen.direction, time)));
        }
        if (!point) return std::nullopt;
        const double w = seen.surface ? 1 : 0;
        const auto film = chief_.with_lens(
            time, [&](const ChiefRays& lens) { return lens.film_point(*point, w); });
        if (!film) return std::nullopt;
        return settings_.sensor.px_from_mm(*film - shift(time));
    }

    /// Where it lands at the moment of the line on which it lands; `px` is a first guess.
    std::optional<Vec2d> landing(const Truth::Seen& seen, Vec2d px) const {
        if (!settings_.shutter.rolls()) return px_of(seen, time_at(px));
        for (int round = 0; round < kRounds;
             ++round) {  // settles if it is slower than the lines
            const auto next = px_of(seen, time_at(px));
            if (!next || length(*next - px) < kSettled) return next;
            px = *next;
        }
        return bisected(seen);
    }

  private:
    /// Of the film, mm, beside what the sensor has anyway.
    Vec2d shift(float time) const {
        if (camera_.setting.values.empty()) return {};
        const Vec2f mm = camera_.setting.at(time).film_shift_mm;
        return {mm.x, mm.y};
    }

    /// As fast as the lines, or faster. Before the first line and past the last one time
    /// is held, so it lands there or crosses some line in between.
    std::optional<Vec2d> bisected(const Truth::Seen& seen) const {
        const bool columns = settings_.shutter.scans_columns();
        double low = 0, high = columns ? settings_.sensor.width : settings_.sensor.height;
        std::optional<Vec2d> px;
        for (int i = 0; i < 50; ++i) {
            const double middle = i == 0 ? low : i == 1 ? high : 0.5 * (low + high);
            px = px_of(seen, time_at({middle, middle}));
            if (!px) return px;
            const bool further = (columns ? px->x : px->y) > middle;
            if (further == (i == 1) && i < 2) return px;  // outside of the frame
            (further ? low : high) = middle;
        }
        return px;
    }

    const Scene& scene_;
    const Camera& camera_;
    const RenderSettings& settings_;
    ChiefRaysOverTime chief_;
};

Vec2d centre(const FilmLayout& region, std::size_t i) {
    return {region.offset_x + double(i % region.width) + 0.5,
            region.offset_y + double(i / region.width) + 0.5};
}

/// Calls use(pixel index) for all of a region.
template <typename Use>
void for_each_pixel(const FilmLayout& region, const RenderSettings& settings,
                    const Use& use) {
    oneapi::tbb::task_arena arena(
        settings.threads > 0 ? settings.threads : oneapi::tbb::task_arena::automatic);
    arena.execute([&] {
        oneapi::tbb::parallel_for(0, region.height, [&](int row) {
            for (int x = 0; x < region.width; ++x)
                use(std::size_t(row) * region.width + x);
        });
    });
}

void note_surface(Truth& truth, std::size_t i, const Scene& scene, const Ray& ray,
                  const RawHit& hit, const Affine3d& camera) {
    const Scene::Hit found = scene.surface(ray, hit);
    const SurfaceHit& s = found.surface;
    const Vec3d from_camera = to_double(s.position) - camera.origin;
    truth.depth[i] = float(-dot(from_camera, camera.z));
    truth.distance[i] = float(length(from_camera));
    truth.position[i] = s.position;
    truth.normal[i] = truth.seen[i].direction = s.ns;
    if (found.sphere_light >= 0) return;
    truth.object_id[i] = s.instance + 1;
    truth.material_id[i] = scene.description().instances[s.instance].material + 1;
}

}  // namespace

Truth see(const TruthFrame& frame, const FilmLayout& region,
          const RenderSettings& settings) {
    const std::size_t n = std::size_t(region.width) * region.height;
    Truth truth{region,
                std::vector<Truth::Seen>(n),
                std::vector<float>(n),
                std::vector<float>(n),
                std::vector<Vec3f>(n),
                std::vector<Vec3f>(n),
                std::vector<std::uint32_t>(n),
                std::vector<std::uint32_t>(n)};
    const View view(frame, settings);
    for_each_pixel(region, settings, [&](std::size_t i) {
        const std::optional<Ray> ray = view.ray(centre(region, i));
        if (!ray) return;
        const auto hit = frame.scene.first_hit(*ray);
        truth.seen[i] = {hit.value_or(RawHit{}), hit.has_value(),
                         frame.scene.sky_from_world(ray->direction, ray->time)};
        if (hit) note_surface(truth, i, frame.scene, *ray, *hit, view.pose(ray->time));
    });
    return truth;
}

std::vector<Vec2d> places(const Truth& truth, const TruthFrame& frame,
                          const RenderSettings& settings) {
    std::vector<Vec2d> px(truth.seen.size());
    const View view(frame, settings);
    for_each_pixel(truth.region, settings, [&](std::size_t i) {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        px[i] = view.landing(truth.seen[i], centre(truth.region, i))
                    .value_or(Vec2d{kNone, kNone});
    });
    return px;
}

}  // namespace dg
