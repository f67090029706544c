#include "render/light_pass.h"

#include <cmath>

#include "math/hash.h"

namespace dg {
namespace {

constexpr int kSequence = -1;     // in place of a pixel row, in the sampler's scramble

}  // namespace

IndexRange light_path_range(double begin, double end, double per_sample, std::uint64_t seed) {
    const double offset = hash_uniform(seed, 0x11947);   // makes fractional numbers of paths correct on average
    const auto until = [&](double sample) {
        return std::uint64_t(std::floor(sample * per_sample + offset));
    };
    return {until(begin), until(end)};
}

LightPass::LightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone)
    : picture_(picture), weight_(weight), cone_(cone) {
    const bool exact = std::holds_alternative<ExactLens>(picture.camera.lens);
    end_secondary_ = exact && picture.settings.dispersion == Dispersion::end_secondary;
    landings_ = exact && !end_secondary_ ? kWavelengths : 1;
}

void StraightLightPass::draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
    draw_each(work, first, last, [&](std::uint64_t i) {
        if (auto path = begin(i)) work.paths.push_back(*path);
    });
}

void BouncedLightPass::draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
    draw_each(work, first, last,
              [&](std::uint64_t i) { paths_.follow(i, work.paths, work.counters.rays); });
}

/// Empty if the path carries no light. Sampling order: time and wavelengths, the emitter, the point of the lens, the
/// point on the emitter. Lens and emitter are stratified jointly.
std::optional<LightArrival> StraightLightPass::begin(std::uint64_t index) const {
    const auto& [scene, camera, film, settings, density] = picture_;
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index),
                        settings.seed);
    const CameraRandom u = sampler.camera();
    const Moment moment = settings.shutter.draw_any(u.time);
    const auto point = weight_.emission().sample(u.film.x, sampler.next_2d(), moment.time,
                                                 weight_.viewpoint(moment.time));
    if (!point) return std::nullopt;
    const bool sky = point->light == EmissionPoint::kSky;
    const Affine3d to_camera = inverse(weight_.pose(moment.time));
    const Vec3d at = to_double(point->position);
    const Vec3d p = sky ? to_camera.vector(at) : to_camera.point(at);
    const auto lens = weight_.pupil().sample(p, sky ? 0 : 1, u.lens, moment.time);
    if (!lens || !(lens->pdf > 0)) return std::nullopt;
    LightArrival path;
    path.lens.ray = Ray{.origin = lens->origin, .direction = lens->direction, .time = moment.time};
    path.lens.iris_opening = moment.iris_opening * setting_at(camera, moment.time).iris_opening;
    const Ray world = to_world(camera, path.lens.ray);
    path.lens.ray.t_min = world.t_min;
    const float cosine = sky ? 1 : std::abs(dot(point->normal, world.direction));
    path.density = weight_.direct_density(point->pdf, lens->pdf, cosine);
    if (!(path.density > 0) || !std::isfinite(path.density)) return std::nullopt;
    path.wavelengths = Wavelengths::sample(u.lambda);
    if (end_secondary_) path.wavelengths.end_secondary();
    if (scene.is_uneven(*point)) {
        path.source = *point;
    } else {
        const Rgb luminance = scene.emission(*point, -world.direction, moment.time);
        if (!(max_component(luminance) > 0)) return std::nullopt;
        path.radiance = path.wavelengths.emission(luminance);
    }
    path.shadow = sky ? world : shadow_ray(point->position, cosine, world);
    path.u_pixel = sampler.next_2d();
    path.sample = std::uint32_t(double(index) / settings.light.m1);
    return path;
}

/// Traces the paths of a batch to the film, and splats or logs them.
void LightPass::trace(Workspace& work) const {
    work.rays.clear(), work.nm.clear();
    for (const LightArrival& path : work.paths)
        for (int k = 0; k < landings_; ++k) {
            work.rays.push_back(path.lens);
            work.nm.push_back(path.wavelengths.nm[k]);
        }
    work.landings.assign(work.rays.size(), Reprojection{});
    if (!work.rays.empty()) reproject(picture_.camera, work.rays, work.nm, work.landings);
    for (std::size_t i = 0; i < work.paths.size(); ++i) {
        const std::span<Reprojection> own(work.landings.data() + i * landings_, std::size_t(landings_));
        if (work.paths[i].source) look(work.paths[i], own);
        undo_film_shift(picture_.camera, std::span(work.rays).subspan(i * std::size_t(landings_), own.size()), own);
        finish(work, work.paths[i], own);
    }
    work.paths.clear();
}

/// Looks up emission with the ray cone of a camera sample that draws this ray.
void LightPass::look(LightArrival& path, std::span<const Reprojection> landings) const {
    const auto hero = std::ranges::find_if(landings, [](const auto& l) { return l.etendue > 0; });
    if (hero == landings.end()) return;
    const RayCone cone = cone_.at(hero->film_mm, path.lens.ray);
    const Rgb luminance = picture_.scene.emission(*path.source, path.shadow.direction, path.shadow.time,
                                          cone.after(path.lens.ray.t_min + path.shadow.t_max).width);
    path.radiance = path.wavelengths.emission(luminance);
}

void LightPass::finish(Workspace& work, const LightArrival& path,
                       std::span<const Reprojection> landings) const {
    const RayOnFilm film_ray(picture_.density, picture_.settings.sensor, landings, path.lens.ray.time);
    work.counters.splats_off_film += film_ray.off_frame();
    if (!film_ray.in_reach() || path.radiance.is_black()) return;
    ++work.counters.rays;
    if (!is_traceable(path.shadow)) return;
    const Spectrum visible = picture_.scene.visibility_along(path.shadow, path.wavelengths);
    if (visible.is_black()) return;
    const double light = path.density, camera = film_ray.camera_density();
    const Spectrum radiance = path.radiance * visible;
    if (!work.log) {
        film_ray.splat(picture_.film, radiance * float(1 / weight_.divisor(light, camera)), path.wavelengths,
                       path.u_pixel, path.sample);
        return;
    }
    std::array<RayOnFilm::Splat, kWavelengths> splats;
    const int count =
        film_ray.choose(radiance * float(1 / light), path.u_pixel, splats);
    for (int k = 0; k < count; ++k)
        work.log->push_back({splats[k].pixel, path.wavelengths.to_xyz(splats[k].light),
                             camera / light, film_ray.spread(), path.sample});
}

}  // namespace dg
