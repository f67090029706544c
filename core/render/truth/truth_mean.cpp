#include "render/truth/truth_mean.h"

#include <algorithm>
#include <limits>
#include <map>

#include "math/sampler.h"
#include "render/parallel.h"
#include "render/truth/truth_view.h"

namespace dg {
namespace {

/// Generates the rays of pixels.
class PixelRays {
  public:
    PixelRays(const TruthView& view, int count)
        : view_(view), samples_(count), rays_(count) {}

    /// Calls use(world ray, weight) for rays that pass the lens; `i`: index of the pixel in `region`.
    template <typename Use>
    void draw(const FilmLayout& region, std::size_t i, const Use& use) {
        const Vec2d middle = centre(region, i);
        const float time = view_.time_at(middle);
        const LensSetting lens = setting_at(view_.camera(), time);
        for (std::size_t k = 0; k < samples_.size(); ++k) {
            const PathSampler sampler(int(middle.x), int(middle.y), std::uint32_t(k), 0);
            const CameraRandom u = sampler.camera();
            const Vec2f px{float(middle.x) - 0.5f + u.film.x, float(middle.y) - 0.5f + u.film.y};
            samples_[k] = {view_.settings().sensor.mm_from_px(px) + lens.film_shift_mm, u.lens,
                           time, float(kDesignWavelength), lens.iris_opening};
        }
        std::ranges::fill(rays_, CameraRay{});
        generate_rays(view_.camera(), samples_, rays_);
        for (const CameraRay& r : rays_) {
            if (!(r.weight > 0)) continue;
            const Ray ray = to_world(view_.camera(), r.ray);
            if (is_traceable(ray)) use(ray, double(r.weight));
        }
    }

  private:
    const TruthView& view_;
    std::vector<CameraSample> samples_;
    std::vector<CameraRay> rays_;
};

/// Light of each ID.
using Shares = std::map<std::uint32_t, double>;

std::uint32_t largest(const Shares& shares) {
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    return shares.empty() ? 0 : std::ranges::max_element(shares, less)->first;
}

/// Sums over the rays of a pixel.
struct PixelSums {
    double light = 0, met = 0, depth = 0, distance = 0;
    Vec3d position{}, normal{};
    Shares objects, materials;

    void add(double weight, const TruthPoint& point) {
        met += weight;
        depth += weight * point.depth, distance += weight * point.distance;
        position += weight * to_double(point.position);
        normal += weight * to_double(point.normal);
    }
    void put(MeanTruth& truth, std::size_t i) const {
        truth.object_id[i] = largest(objects), truth.material_id[i] = largest(materials);
        if (!(met > 0)) return;
        truth.coverage[i] = float(met / light);
        truth.depth[i] = float(depth / met), truth.distance[i] = float(distance / met);
        truth.position[i] = to_float(position / met);
        if (length(normal) > 1e-6 * met) truth.normal[i] = to_float(normalize(normal));
    }
};

/// Calls use(rays, pixel) for all pixels of a region, in parallel over rows.
template <typename Use>
void for_each_pixel(const TruthView& view, const FilmLayout& region, int rays,
                    const Use& use) {
    parallel_tasks(view.settings().threads, region.height, [&](std::int64_t row) {
        PixelRays drawn(view, rays);
        for (int x = 0; x < region.width; ++x) use(drawn, std::size_t(row) * region.width + x);
    });
}

/// Sums over points that are imaged in both frames.
struct MotionSums {
    Vec2d moved{};
    double weight = 0;
};

Seen what_sees(const Scene& scene, const Ray& ray) {
    const auto hit = scene.first_hit(ray);
    if (!hit) return {{}, false, scene.sky_from_world(ray.direction, ray.time)};
    // Only points of spheres are identified by their normal.
    const bool sphere = hit->instance == RawHit::kSphere;
    return {*hit, true, sphere ? scene.surface(ray, *hit).surface.ns : Vec3f{}};
}

}  // namespace

MeanTruth::MeanTruth(const FilmLayout& region)
    : TruthPlanes(region), coverage(depth.size()) {}

MeanTruth see_mean(const TruthFrame& frame, const FilmLayout& region,
                   const RenderSettings& settings, int rays) {
    MeanTruth truth(region);
    const TruthView view(frame, settings);
    for_each_pixel(view, region, rays, [&](PixelRays& drawn, std::size_t i) {
        PixelSums sums;
        drawn.draw(region, i, [&](const Ray& ray, double weight) {
            const auto hit = frame.scene.first_hit(ray);
            TruthPoint point{};
            if (hit) {
                point = truth_point(frame.scene, ray, *hit, view.pose(ray.time));
                sums.add(weight, point);
            }
            sums.light += weight;
            sums.objects[point.object_id] += weight;
            sums.materials[point.material_id] += weight;
        });
        sums.put(truth, i);
    });
    return truth;
}

std::vector<Vec2d> mean_motion(const TruthFrame& now, const RenderSettings& now_settings,
                               const TruthFrame& then, const RenderSettings& then_settings,
                               const FilmLayout& region, int rays) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec2d> motion(std::size_t(region.width) * region.height, {kNone, kNone});
    const TruthView here(now, now_settings), there(then, then_settings);
    for_each_pixel(here, region, rays, [&](PixelRays& drawn, std::size_t i) {
        MotionSums sky, surfaces;
        bool met = false;
        drawn.draw(region, i, [&](const Ray& ray, double weight) {
            const Seen seen = what_sees(now.scene, ray);
            met |= seen.surface;
            const auto from = here.landing(seen, centre(region, i));
            const auto to = from ? there.landing(seen, *from) : std::nullopt;
            if (!to) return;
            MotionSums& sums = seen.surface ? surfaces : sky;
            sums.moved = sums.moved + (*to - *from) * weight, sums.weight += weight;
        });
        const MotionSums& sums = met ? surfaces : sky;
        if (sums.weight > 0) motion[i] = sums.moved * (1 / sums.weight);
    });
    return motion;
}

}  // namespace dg
