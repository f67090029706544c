#include "render/flare/scatter_pass.h"

#include "math/hash.h"

namespace dg {
namespace {

constexpr int kSequence = -6;   // where pixels have their row, in the sampler's scramble

}  // namespace

ScatterPass::ScatterPass(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& settings,
                         const FilmDensity& density, double per_sample, const ScatterGuide& guide)
    : scene_(scene),
      camera_(camera),
      film_(film),
      settings_(settings),
      density_(density),
      guide_(guide),
      per_sample_(per_sample),
      scale_(density.integral_of_any_time()) {}

void ScatterPass::draw(RenderCounters& counters, std::uint64_t first, std::uint64_t last) const {
    for (std::uint64_t i = first; i < last; ++i) draw_one(counters, i);
    counters.scatter_paths += last - first;
}

/// Order of drawing: source, point of the front, time and wavelengths are stratified together.
void ScatterPass::draw_one(RenderCounters& counters, std::uint64_t index) const {
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index), settings_.seed);
    const CameraRandom u = sampler.camera();
    const FlareAim::Random random{u.film.y, u.lambda, sampler.next_2d(), settings_.shutter.draw_any(u.time)};
    const auto path = guide_.draw(u.film.x, u.lens, random);
    if (!path) return;
    const float time = path->lens.ray.time;
    ScatterGuide::Landings landings = guide_.trace(*path, hash64(settings_.seed, index));
    if (guide_.aim().mark_arrived(landings, time) == 0) return;
    ++counters.scatter_hits;
    const RayOnFilm film_ray(density_, settings_.sensor, landings, time);
    if (!film_ray.in_reach()) return;
    const Vec2f u_pixel = sampler.next_2d();
    const Spectrum light = flare_light(scene_, camera_, settings_.path, *path, sampler, counters.rays);
    if (light.is_black()) return;
    film_ray.splat(film_, light * float(1 / (path->density * per_sample_ * scale_)), path->wavelengths, u_pixel,
                   std::uint32_t(double(index) / settings_.scatter.per_sample), Film::Layer::flare);
}

}  // namespace dg
