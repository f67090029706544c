#include "render/render.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "camera/pixel_cone.h"
#include "math/error.h"
#include "render/dispersion.h"
#include "render/flare/flare_pass.h"
#include "render/flare/scatter_pass.h"
#include "render/light_pass.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr int kTileSize = 16;      // px: neighbours share geometry in the caches
constexpr int kLightBlock = 4096;  // light paths of one task
constexpr int kScatterBlock = 2048;
constexpr int kFlareBlock = 16384; // flare paths: enough of one ghost to fill the SIMD lanes
constexpr int kBatchSize = 1024;   // camera samples per call of the lens: fills the SIMD lanes

/// One camera sample on its way from random numbers to the film.
struct Sample {
    Pixel pixel;
    std::uint32_t index;
    Vec2f px;              // film point
    float weight;          // of filter and shutter
    PathSampler sampler;
    Wavelengths wavelengths;
};

/// Buffers of one thread, kept from tile to tile.
struct Workspace {
    std::vector<Sample> samples;
    std::vector<CameraSample> camera_samples;
    std::vector<CameraRay> rays;
    std::vector<CameraRay> traced_rays;           // of the samples that passed, each some times
    std::vector<float> traced_nm;
    std::vector<Reprojection> reprojections;
    RenderCounters counters;
    LightPass::Workspace light;
    FlarePass::Workspace flare;
    RenderCounters scatter;
};

RenderCounters operator+(const RenderCounters& a, const RenderCounters& b) {
    return {a.camera_rays + b.camera_rays, a.stopped_rays + b.stopped_rays, a.rays + b.rays,
            a.light_paths + b.light_paths, a.splats_off_film + b.splats_off_film,
            a.flare_paths + b.flare_paths, a.flare_rays + b.flare_rays, a.flare_hits + b.flare_hits,
            a.scatter_paths + b.scatter_paths, a.scatter_hits + b.scatter_hits};
}

/// Light paths [first, last) in blocks.
struct LightTasks {
    std::uint64_t first, last, size;
    LightTasks(std::array<std::uint64_t, 2> range, int block) : first(range[0]), last(range[1]), size(block) {}
    std::int64_t count() const { return std::int64_t((last - first + size - 1) / size); }
    std::array<std::uint64_t, 2> operator[](std::int64_t block) const {
        const std::uint64_t begin = first + std::uint64_t(block) * size;
        return {begin, std::min(begin + size, last)};
    }
};

/// The part of a film's region that is drawn.
FilmLayout cut(FilmLayout region, const PixelBox& window) {
    if (window.empty()) return region;
    const int x0 = std::max(region.offset_x, window.x0), x1 = std::min(region.offset_x + region.width, window.x1),
              y0 = std::max(region.offset_y, window.y0), y1 = std::min(region.offset_y + region.height, window.y1);
    region.offset_x = x0, region.offset_y = y0;
    region.width = std::max(0, x1 - x0), region.height = std::max(0, y1 - y0);
    return region;
}

/// Calls use(pixel, its index in the film) for the pixels of a region that are not in the hole.
template <typename Use>
void for_each_drawn(const FilmLayout& region, const FilmLayout& film, const PixelBox& hole, const Use& use) {
    for (int y = region.offset_y; y < region.offset_y + region.height; ++y)
        for (int x = region.offset_x; x < region.offset_x + region.width; ++x)
            if (!hole.contains(x, y))
                use(Pixel{x, y}, std::size_t(y - film.offset_y) * film.width + (x - film.offset_x));
}

/// Sums of a round over the pixels that are drawn.
struct RoundSums {
    UInt128 begin = 0, count = 0;
    std::size_t pixels = 0;
    RoundSums(const RenderSettings& settings, const FilmLayout& region, const FilmLayout& film) {
        for_each_drawn(region, film, settings.hole, [&](Pixel, std::size_t i) {
            begin += settings.round.begin[i], count += settings.round.count[i], ++pixels;
        });
    }
    double mean_count() const { return double(count) / double(pixels); }
    /// Mean sample index up to which a part is drawn: the same number, to the bit, at the end of one round
    /// and the begin of the next.
    double until(std::uint32_t part) const {
        return double(begin * SampleRound::kParts + count * part) / (double(pixels) * SampleRound::kParts);
    }
};

class Renderer {
  public:
    Renderer(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& settings)
        : scene_(scene), camera_(camera), film_(film), settings_(settings),
          exact_(settings.dispersion == Dispersion::reproject
                     ? std::get_if<ExactLens>(&camera.lens)
                     : nullptr),
          end_secondary_(settings.dispersion == Dispersion::end_secondary &&
                         std::holds_alternative<ExactLens>(camera.lens)),
          region_(cut(film.layout(), settings.window)),
          counts_(counts_of(settings, region_, film.layout())),
          density_(settings.filter, region_, uneven(counts_), &settings.shutter),
          weight_(scene, camera, settings.sensor, density_, plan(), settings.technique,
                  settings.light_guide) {
        if (film.responses().count() != film.layout().channels)
            throw input_error("render", "film", "responses of its channels", "none");
        if (!scene.textures().empty()) cone_ = PixelCone(camera, settings.sensor);
        if (weight_.draws_light())
            light_.emplace(scene, camera, film, settings, density_, weight_, cone_);
        if (settings.flare.per_sample > 0) set_up_flare();
        if (settings.scatter.per_sample > 0) set_up_scatter();
        // Where light paths share in what is found, the hero's own landing is needed too.
        first_traced_ = weight_.off() ? 1 : 0;
        end_traced_ = exact_ ? kWavelengths : weight_.off() ? 0 : 1;
    }

    /// Indices of the light paths that belong to these samples, `per_sample` to each.
    std::array<std::uint64_t, 2> light_paths(double per_sample) const {
        return light_ ? paths(per_sample) : std::array<std::uint64_t, 2>{0, 0};
    }
    std::array<std::uint64_t, 2> flare_paths() const {
        return flare_ ? paths(settings_.flare.per_sample) : std::array<std::uint64_t, 2>{0, 0};
    }
    std::array<std::uint64_t, 2> scatter_paths() const {
        return scatter_ ? paths(settings_.scatter.per_sample) : std::array<std::uint64_t, 2>{0, 0};
    }
    std::array<std::uint64_t, 2> paths(double per_sample) const {
        const SampleRound& round = settings_.round;
        double begin = settings_.sample_begin, end = settings_.sample_end;
        if (!round.count.empty()) {
            const RoundSums sums = round_sums();
            begin = sums.until(round.first), end = sums.until(round.last);
        }
        return light_path_range(begin, end, per_sample, settings_.seed);
    }
    /// Region of the film that is drawn, but for the hole.
    const FilmLayout& region() const { return region_; }
    void draw_light(Workspace& work, std::uint64_t first, std::uint64_t last, bool bounced) const {
        if (bounced)
            light_->draw_bounced(work.light, first, last);
        else
            light_->draw(work.light, first, last);
    }

    void draw_flare(Workspace& work, std::uint64_t first, std::uint64_t last) const {
        flare_->draw(work.flare, first, last);
    }

    void draw_scatter(Workspace& work, std::uint64_t first, std::uint64_t last) const {
        scatter_->draw(work.scatter, first, last);
    }

    void draw_tile(Workspace& work, int x0, int y0, int x1, int y1) const {
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const auto [begin, end] = samples_of({x, y});
                for (std::uint32_t i = begin; i < end; ++i) {
                    add_sample(work, {x, y}, i);
                    if (work.samples.size() == kBatchSize) draw_batch(work);
                }
            }
        draw_batch(work);
    }

  private:
    /// Counts that are all alike need no weighing (FilmDensity).
    static std::span<const std::uint32_t> uneven(std::span<const std::uint32_t> counts) {
        const bool even = std::ranges::adjacent_find(counts, std::not_equal_to<>{}) == counts.end();
        return even ? std::span<const std::uint32_t>{} : counts;
    }

    /// Samples of each pixel of the region, where they may differ: of a round, or of a region with a hole, 1 and 0.
    static std::vector<std::uint32_t> counts_of(const RenderSettings& settings, const FilmLayout& region,
                                                const FilmLayout& film) {
        const SampleRound& round = settings.round;
        if (round.count.empty() && settings.hole.empty()) return {};
        std::vector<std::uint32_t> counts(std::size_t(region.width) * region.height);
        for_each_drawn(region, film, settings.hole, [&](Pixel p, std::size_t i) {
            counts[std::size_t(p.y - region.offset_y) * region.width + (p.x - region.offset_x)] =
                round.count.empty() ? 1 : round.count[i];
        });
        return counts;
    }
    RoundSums round_sums() const { return {settings_, region_, film_.layout()}; }

    /// Sample indices per unit of the density's counts, which are those of a whole round.
    double samples_per_count() const {
        return density_.even() || settings_.round.count.empty() ? 1 : round_sums().mean_count();
    }
    LightPlan plan() const {
        return {settings_.light.m1 * samples_per_count(), settings_.light.m2 * samples_per_count()};
    }
    void set_up_flare() {
        if (!std::holds_alternative<ExactLens>(camera_.lens))
            throw input_error("render", "flare", "a lens that is traced", "an ideal one");
        flare_guide_ = settings_.flare.guide;
        if (!flare_guide_)
            flare_guide_ = std::make_shared<const FlareGuide>(
                std::make_shared<const FlareAim>(scene_, camera_, settings_), settings_);
        if (!flare_guide_->empty())
            flare_.emplace(scene_, camera_, film_, settings_, density_,
                           settings_.flare.per_sample * samples_per_count(), *flare_guide_);
    }

    void set_up_scatter() {
        if (!std::holds_alternative<ExactLens>(camera_.lens))
            throw input_error("render", "scatter", "a lens that is traced", "an ideal one");
        scatter_guide_ = settings_.scatter.guide;
        if (!scatter_guide_)
            scatter_guide_ = std::make_shared<const ScatterGuide>(
                flare_guide_ ? flare_guide_->shared_aim()
                             : std::make_shared<const FlareAim>(scene_, camera_, settings_),
                scene_, camera_, settings_);
        if (!scatter_guide_->empty())
            scatter_.emplace(scene_, camera_, film_, settings_, density_,
                             settings_.scatter.per_sample * samples_per_count(), *scatter_guide_);
    }

    /// Samples [begin, end) that this call draws of a pixel.
    std::array<std::uint32_t, 2> samples_of(Pixel pixel) const {
        if (settings_.hole.contains(pixel.x, pixel.y)) return {0, 0};
        if (settings_.round.count.empty()) return {settings_.sample_begin, settings_.sample_end};
        const FilmLayout& region = film_.layout();
        return settings_.round.samples(std::size_t(pixel.y - region.offset_y) * region.width +
                                       pixel.x - region.offset_x);
    }

    /// Order of drawing: pixel and film point, the time within the pixel's window, wavelengths; the lens
    /// as it is at that time follows for the whole batch, then the pose.
    void add_sample(Workspace& work, Pixel pixel, std::uint32_t index) const {
        const PathSampler sampler(pixel.x, pixel.y, index, settings_.seed);
        const CameraRandom u = sampler.camera();
        const FilterSample f = settings_.filter.sample(u.film);
        const Vec2f px{pixel.x + 0.5f + f.offset.x, pixel.y + 0.5f + f.offset.y};
        const Wavelengths wavelengths = Wavelengths::sample(u.lambda);
        const Moment moment = settings_.shutter.draw(pixel.x, pixel.y, u.time);
        const LensSetting lens = setting_at(camera_, moment.time);
        work.camera_samples.push_back({settings_.sensor.mm_from_px(px) + lens.film_shift_mm, u.lens,
                                       moment.time, wavelengths.nm[0],
                                       moment.iris_opening * lens.iris_opening});
        work.samples.push_back({pixel, index, px, f.weight * settings_.shutter.weight(), sampler,
                                wavelengths});
    }


    void draw_batch(Workspace& work) const {
        const std::size_t n = work.samples.size();
        work.rays.assign(n, CameraRay{});
        generate_rays(camera_, work.camera_samples, work.rays);
        if (end_traced_ > 0) reproject(work);
        std::size_t passed = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Sample& sample = work.samples[i];
            film_.count(sample.pixel.x, sample.pixel.y);
            if (work.rays[i].weight > 0) draw_sample(work, i, passed++);
        }
        work.counters.camera_rays += n;
        work.counters.stopped_rays += n - passed;
        work.samples.clear();
        work.camera_samples.clear();
    }

    /// Film points of wavelengths [first_traced_, end_traced_), for the rays that passed.
    void reproject(Workspace& work) const {
        work.traced_rays.clear();
        work.traced_nm.clear();
        for (std::size_t i = 0; i < work.rays.size(); ++i) {
            if (work.rays[i].weight <= 0) continue;
            for (int k = first_traced_; k < end_traced_; ++k) {
                work.traced_rays.push_back(work.rays[i]);
                work.traced_nm.push_back(work.samples[i].wavelengths.nm[k]);
            }
        }
        work.reprojections.assign(work.traced_rays.size(), Reprojection{});
        dg::reproject(camera_, work.traced_rays, work.traced_nm, work.reprojections);
        if (!camera_.setting.moves()) return;
        for (std::size_t i = 0; i < work.reprojections.size(); ++i) {   // the film lay elsewhere then
            Vec2f& film = work.reprojections[i].film_mm;
            film = film - setting_at(camera_, work.traced_rays[i].ray.time).film_shift_mm;
        }
    }

    void draw_sample(Workspace& work, std::size_t i, std::size_t passed) const {
        Sample& sample = work.samples[i];
        const CameraRay& camera_ray = work.rays[i];
        Ray ray = to_world(camera_, camera_ray.ray);
        ray.cone = cone_.at(work.camera_samples[i].film_mm, camera_ray.ray);
        if (end_secondary_) sample.wavelengths.end_secondary();
        const std::size_t traced = std::size_t(std::max(0, end_traced_ - first_traced_));
        const std::span landings(work.reprojections.data() + passed * traced, traced);
        std::optional<FirstRay> first;
        if (!weight_.off())
            first.emplace(weight_, camera_ray.ray, density_, settings_.sensor, landings);
        AovSample aov;
        AovSample* const wanted = film_.layout().aovs ? &aov : nullptr;
        const Radiance light = radiance(scene_, ray, sample.wavelengths, sample.sampler,
                                        settings_.path, wanted, &work.counters.rays,
                                        first ? &*first : nullptr);
        if (wanted) add_aov(sample, ray.time, aov);
        if (exact_) {
            splat(sample, camera_ray, landings.subspan(1 - first_traced_), light);
        } else {
            film_.add(sample.pixel.x, sample.pixel.y, sample.index,
                      sample.wavelengths, light.sum() * (camera_ray.weight * sample.weight));
        }
    }

    /// Each wavelength at its own film point; those of one pixel are added as one value. Light that only
    /// this hero could have found (Radiance::hero) has no share in the heuristic over four heroes that
    /// weighs the landings: another hero would have been bent elsewhere in the scene, so its technique
    /// has the density 0 for this path. It has the plain weight of the hero's own film sample.
    void splat(const Sample& sample, const CameraRay& camera_ray,
               std::span<const Reprojection> others, const Radiance& light) const {
        const Hero hero{sample.px, sample.pixel, camera_ray.ray.time, camera_ray.weight,
                        camera_ray.aim_weight};
        PathSampler sampler = sample.sampler;
        const Landings landings =
            land(density_, settings_.sensor, hero, others, sampler.next_1d());
        Spectrum own = light.hero * (camera_ray.weight * sample.weight);
        for (const Landing& l : landings) {   // the hero's own pixel comes first
            film_.add_shared(l.pixel.x, l.pixel.y, sample.index,
                             sample.wavelengths, own + light.shared * l.weight);
            own = 0.f;
        }
    }

    void add_aov(const Sample& sample, float time, AovSample& aov) const {
        aov.alpha = aov.hit ? 1 : 0;
        if (aov.hit) {
            const Affine3d camera = camera_.world_from_camera.at(time);
            aov.depth = float(-dot(to_double(aov.position) - camera.origin, camera.z));
        }
        film_.add_aov(sample.pixel.x, sample.pixel.y, sample.index, aov);
    }

    const Scene& scene_;
    const Camera& camera_;
    Film& film_;
    const RenderSettings& settings_;
    const ExactLens* exact_;   // the lens whose wavelengths are reprojected, else null
    bool end_secondary_;
    FilmLayout region_;
    std::vector<std::uint32_t> counts_;   // of its pixels, unless all are alike
    FilmDensity density_;
    LightWeight weight_;
    PixelCone cone_;           // none where the scene has no textures
    std::optional<LightPass> light_;
    std::shared_ptr<const FlareGuide> flare_guide_;   // null where none is drawn
    std::optional<FlarePass> flare_;
    std::shared_ptr<const ScatterGuide> scatter_guide_;   // null where none is drawn
    std::optional<ScatterPass> scatter_;
    int first_traced_, end_traced_;
};

}  // namespace

RenderCounters render(const Scene& scene, const Camera& camera, Film& film,
                      const RenderSettings& settings,
                      const std::function<bool(double)>& progress) {
    const Renderer renderer(scene, camera, film, settings);
    const FilmLayout& region = renderer.region();
    const int x0 = region.offset_x, y0 = region.offset_y;
    const int columns = (region.width + kTileSize - 1) / kTileSize;
    const int rows = (region.height + kTileSize - 1) / kTileSize;
    oneapi::tbb::enumerable_thread_specific<Workspace> workspaces;
    const LightTasks straight(renderer.light_paths(settings.light.m1), kLightBlock),
        bounced(renderer.light_paths(settings.light.m2), kLightBlock),
        flare(renderer.flare_paths(), kFlareBlock), scatter(renderer.scatter_paths(), kScatterBlock);
    const std::int64_t tiles = std::int64_t(columns) * rows;
    const std::int64_t light = tiles + straight.count() + bounced.count(), ghosts = light + flare.count();
    const std::int64_t tasks = ghosts + scatter.count();
    std::atomic<std::int64_t> done{0};
    std::atomic<bool> stop{false};
    const auto draw = [&](std::int64_t task) {
        if (stop) return;
        Workspace& work = workspaces.local();
        if (task < tiles) {
            const int x = x0 + int(task % columns) * kTileSize, y = y0 + int(task / columns) * kTileSize;
            renderer.draw_tile(work, x, y, std::min(x + kTileSize, x0 + region.width),
                               std::min(y + kTileSize, y0 + region.height));
        } else if (task >= ghosts) {
            const auto [first, last] = scatter[task - ghosts];
            renderer.draw_scatter(work, first, last);
        } else if (task >= light) {
            const auto [first, last] = flare[task - light];
            renderer.draw_flare(work, first, last);
        } else {
            const bool bounces = task >= tiles + straight.count();
            const auto [first, last] =
                bounces ? bounced[task - tiles - straight.count()] : straight[task - tiles];
            renderer.draw_light(work, first, last, bounces);
        }
        if (progress && !progress(double(++done) / double(tasks))) stop = true;
    };
    parallel_tasks(settings.threads, tasks, draw);
    RenderCounters counters;
    for (Workspace& work : workspaces)
        counters = counters + work.counters + work.light.counters + work.flare.counters + work.scatter;
    return counters;
}

}  // namespace dg
