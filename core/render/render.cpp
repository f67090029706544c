#include "render/render.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "camera/inverse/pixel_cone.h"
#include "math/cancel.h"
#include "math/error.h"
#include "render/camera_first_ray.h"
#include "render/dispersion.h"
#include "render/drawn_samples.h"
#include "render/emitter_passes.h"
#include "render/pass.h"
#include "render/solids_near_camera.h"
#include "render/tiles.h"

namespace dg {
namespace {

constexpr int kBatchSize = 1024;   // camera samples per call of the lens: fills the SIMD lanes

/// A camera sample.
struct Sample {
    Pixel pixel;
    std::uint32_t index;
    Vec2f px;              // film point
    float weight;          // product of filter and shutter weights
    PathSampler sampler;
    Wavelengths wavelengths;
};

/// Draws camera samples, tile by tile.
class CameraPass {
  public:
    static constexpr std::uint64_t kBlock = 1;
    struct Workspace {
        std::vector<Sample> samples;
        std::vector<CameraSample> camera_samples;
        std::vector<CameraRay> rays;
        std::vector<CameraRay> traced_rays;   // of samples that passed the lens, for each traced wavelength
        std::vector<float> traced_nm;
        std::vector<Reprojection> reprojections;
        RenderCounters counters;
    };

    CameraPass(const Picture& picture, const DrawnSamples& drawn, const LightWeight& weight, const PixelCone& cone)
        : scene_(picture.scene), camera_(picture.camera), film_(picture.film), settings_(picture.settings),
          density_(picture.density), drawn_(drawn), weight_(weight), cone_(cone), path_(picture.settings.path),
          instances_(std::uint32_t(picture.scene.description().instances.size())) {
        path_.plate = settings_.plate.get();
        const bool exact = std::holds_alternative<ExactLens>(camera_.lens);
        reprojected_ = exact && settings_.dispersion == Dispersion::reproject;
        end_secondary_ = exact && settings_.dispersion == Dispersion::end_secondary;
        // MIS with light paths needs the hero's reprojection, too.
        first_traced_ = weight.off() ? 1 : 0;
        end_traced_ = reprojected_ ? kWavelengths : weight.off() ? 0 : 1;
    }

    /// Draws tiles [first, last).
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
        for (std::uint64_t tile = first; tile < last; ++tile) draw_tile(work, Tiles(drawn_.region())[tile]);
    }

  private:
    void draw_tile(Workspace& work, const PixelBox& tile) const {
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const auto [begin, end] = drawn_.of({x, y});
                for (std::uint32_t i = begin; i < end; ++i) {
                    add_sample(work, {x, y}, i);
                    if (work.samples.size() == kBatchSize) draw_batch(work);
                }
            }
        draw_batch(work);
    }

    /// Samples the film point, the time within the pixel's exposure window, and wavelengths. The lens and the pose at
    /// that time are applied to the whole batch later.
    void add_sample(Workspace& work, Pixel pixel, std::uint32_t index) const {
        const PathSampler sampler(pixel.x, pixel.y, index, settings_.seed);
        const CameraRandom u = sampler.camera();
        const FilterSample f = settings_.filter.sample(u.film);
        const Vec2f px{pixel.x + 0.5f + f.offset.x, pixel.y + 0.5f + f.offset.y};
        const Wavelengths wavelengths = Wavelengths::sample(u.lambda);
        const Moment moment = settings_.shutter.draw(pixel.x, pixel.y, u.time);
        const LensSetting lens = setting_at(camera_, moment.time);
        work.camera_samples.push_back({settings_.sensor.mm_from_px(px) + lens.film_shift_mm, u.lens, moment.time,
                                       wavelengths.nm[0], moment.iris_opening * lens.iris_opening});
        work.samples.push_back({pixel, index, px, f.weight * settings_.shutter.weight(), sampler, wavelengths});
    }

    void draw_batch(Workspace& work) const {
        throw_if_cancelled();
        const std::size_t n = work.samples.size();
        work.rays.assign(n, CameraRay{});
        generate_rays(camera_, work.camera_samples, work.rays);
        if (end_traced_ > 0) reproject(work);
        std::size_t passed = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Sample& sample = work.samples[i];
            film_.count(sample.pixel.x, sample.pixel.y, sample.index);
            if (work.rays[i].weight > 0) draw_sample(work, i, passed++);
        }
        work.counters.camera_rays += n;
        work.counters.stopped_rays += n - passed;
        work.samples.clear(), work.camera_samples.clear();
    }

    /// Computes the film points of wavelengths [first_traced_, end_traced_) for the rays that passed the lens.
    void reproject(Workspace& work) const {
        work.traced_rays.clear(), work.traced_nm.clear();
        for (std::size_t i = 0; i < work.rays.size(); ++i) {
            if (work.rays[i].weight <= 0) continue;
            for (int k = first_traced_; k < end_traced_; ++k) {
                work.traced_rays.push_back(work.rays[i]);
                work.traced_nm.push_back(work.samples[i].wavelengths.nm[k]);
            }
        }
        work.reprojections.assign(work.traced_rays.size(), Reprojection{});
        dg::reproject(camera_, work.traced_rays, work.traced_nm, work.reprojections);
        undo_film_shift(camera_, work.traced_rays, work.reprojections);
    }

    void draw_sample(Workspace& work, std::size_t i, std::size_t passed) const {
        Sample& sample = work.samples[i];
        const CameraRay& camera_ray = work.rays[i];
        Ray ray = to_world(camera_, camera_ray.ray);
        ray.cone = cone_.at(work.camera_samples[i].film_mm, camera_ray.ray);
        if (end_secondary_) sample.wavelengths.end_secondary();
        const std::size_t traced = std::size_t(std::max(0, end_traced_ - first_traced_));
        const std::span landings(work.reprojections.data() + passed * traced, traced);
        std::optional<CameraFirstRay> first;
        if (!weight_.off()) first.emplace(weight_, camera_ray.ray, density_, settings_.sensor, landings);
        FirstHit hit;
        FirstHit* const wanted = film_.count_of(Layer::aovs) ? &hit : nullptr;
        const Sight sight = trace_camera_ray(scene_, ray, sample.wavelengths, sample.sampler, path_, wanted,
                                             &work.counters.rays, first ? &*first : nullptr);
        if (wanted) add_aov(sample, ray.time, hit);
        const Spectrum weight(camera_ray.weight * sample.weight);
        if (reprojected_) {
            splat(sample, camera_ray, landings.subspan(1 - first_traced_), sight, weight);
        } else {
            film_.add(sample.pixel.x, sample.pixel.y, sample.index, sample.wavelengths,
                      arrived(sample, sight, weight, [&](const Radiance& r) { return r.sum() * weight; }));
        }
    }

    /// Light added to a pixel, weighted by `to_film`. Coverage is weighted like the luminance of a uniform white world,
    /// so that it is the covered fraction of the pixel's light.
    template <typename ToFilm>
    CameraLight arrived(const Sample& sample, const Sight& sight, Spectrum weight, const ToFilm& to_film) const {
        CameraLight total{.light = to_film(sight.light)};
        if (film_.count_of(Layer::catchers)) 
            total.with_objects = to_film(sight.with_objects), total.without_objects = to_film(sight.without_objects);
        if (!film_.count_of(Layer::coverage)) return total;
        const Spectrum luminance = sample.wavelengths.d65 * sample.wavelengths.cie_y * weight;
        total.white = 4 * luminance.average();
        total.covered = total.white * sight.covers.sum();
        if (film_.count_of(Layer::objects)) add_objects(total, sight.covers);
        return total;
    }

    /// Adds coverage by object ID: instances by index, followed by sphere lights.
    void add_objects(CameraLight& total, const Covers& covers) const {
        static_assert(CameraLight::kMostObjects >= Covers::kMost);
        for (const Cover& c : covers) {
            const bool sphere = c.instance >= Cover::kSpheres;
            const std::uint32_t object = sphere ? c.instance - Cover::kSpheres + instances_ : c.instance;
            total.objects[total.object_count++] = {object, total.white * c.share};
        }
    }

    /// Splats each wavelength at its film point; wavelengths in the same pixel are added as one value. Radiance::hero
    /// is excluded from the balance heuristic over four heroes: another hero would have been refracted elsewhere in the
    /// scene, so its technique has density 0 for this path. This light has the weight of the hero's film sample alone.
    void splat(const Sample& sample, const CameraRay& camera_ray, std::span<const Reprojection> others,
               const Sight& sight, Spectrum hero_weight) const {
        const Hero hero{sample.px, sample.pixel, camera_ray.ray.time, camera_ray.weight, camera_ray.aim_weight};
        PathSampler sampler = sample.sampler;
        const Landings landings = land(density_, settings_.sensor, hero, others, sampler.next_1d());
        for (const Landing& l : landings) {   // the hero's pixel is first
            const auto to_film = [&](const Radiance& r) { return r.hero * hero_weight + r.any_hero * l.weight; };
            film_.add_locked(l.pixel.x, l.pixel.y, sample.index, sample.wavelengths,
                             arrived(sample, sight, l.weight, to_film));
            hero_weight = 0.f;   // the other pixels have none of the hero's light
        }
    }

    void add_aov(const Sample& sample, float time, const FirstHit& hit) const {
        AovSample aov{.hit = hit.found, .position = hit.position, .normal = hit.normal, .albedo = hit.albedo,
                      .object_id = hit.found ? hit.instance + 1 : 0,
                      .guide_albedo = hit.guide_albedo, .guide_normal = hit.guide_normal};
        if (hit.found) {
            const Affine3d camera = camera_.world_from_camera.at(time);
            aov.depth = float(-dot(to_double(hit.position) - camera.origin, camera.z));
        }
        film_.add_aov(sample.pixel.x, sample.pixel.y, sample.index, aov);
    }

    const Scene& scene_;
    const Camera& camera_;
    Film& film_;
    const RenderSettings& settings_;
    const FilmDensity& density_;
    const DrawnSamples& drawn_;
    const LightWeight& weight_;
    const PixelCone& cone_;
    PathSettings path_;
    std::uint32_t instances_;
    bool reprojected_, end_secondary_;   // treatment of secondary wavelengths
    int first_traced_, end_traced_;
};

}  // namespace

RenderCounters render(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& given,
                      const std::function<bool(double)>& progress) {
    RenderSettings settings = given;
    const std::vector<std::uint32_t> solids_near = solids_near_camera(scene, camera);
    settings.path.solids_near = solids_near;
    if (film.responses().count() != film.count_of(Layer::channels))
        throw input_error("render", "film", "the responses of its channels", "none");
    if (scene.has_catchers() && !(film.count_of(Layer::catchers) && settings.light.off()))
        throw Error("render: a scene with catchers needs a film with catchers, and no light paths");
    const DrawnSamples drawn(settings, film.layout());
    const FilmDensity density(settings.filter, drawn.region(), drawn.counts(), &settings.shutter);
    const Picture picture{scene, camera, film, settings, density};
    const LightWeight weight(scene, camera, settings.sensor, density, settings.light * drawn.per_count(),
                             settings.technique, settings.light_guide);
    const PixelCone cone = scene.textures().empty() ? PixelCone() : PixelCone(camera, settings.sensor);
    Passes passes;
    passes.add<CameraPass>({0, Tiles(drawn.region()).count()}, picture, drawn, weight, cone);
    add_emitter_passes(passes, picture, drawn, weight, cone);
    return passes.draw(settings.threads, progress);
}

}  // namespace dg
