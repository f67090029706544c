#include "render/flare/scatter_pass.h"

#include "math/hash.h"
#include "render/ray_on_film.h"

namespace dg {
namespace {

constexpr int kSequence = -6;   // in place of a pixel row, in the sampler's scramble

}  // namespace

ScatterPass::ScatterPass(const Picture& picture, double per_sample, std::shared_ptr<const ScatterGuide> guide)
    : picture_(picture),
      per_sample_(per_sample),
      scale_(picture.density.integral_of_any_time()),
      guide_(std::move(guide)) {
    if (ScatterNodes::serve(picture, *guide_)) nodes_ = std::make_unique<const ScatterNodes>(picture, *guide_);
}

void ScatterPass::draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
    for (std::uint64_t i = first; i < last; ++i) draw_one(work, i);
    work.counters.scatter_paths += last - first;
    if (nodes_) nodes_->flush(work.arrivals);
}

/// Stratifies source, point of the front, time and wavelengths jointly.
void ScatterPass::draw_one(Workspace& work, std::uint64_t index) const {
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index), picture_.settings.seed);
    const CameraRandom u = sampler.camera();
    const FlareAim::Random random{u.film.y, u.lambda, sampler.next_2d(), picture_.settings.shutter.draw_any(u.time)};
    const auto path = guide_->draw(u.film.x, u.lens, random);
    if (!path) return;
    const float time = path->lens.ray.time;
    ScatterGuide::Landings landings = guide_->trace(*path, hash64(picture_.settings.seed, index));
    const int hits = guide_->aim().mark_arrived(landings.at, time);
    work.counters.scatter_hits += hits > 0;
    if (hits == 0 && !nodes_) return;
    const Vec2f u_pixel = sampler.next_2d();
    const auto places = nodes_ ? nodes_->take(landings, time, u_pixel.x) : ScatterNodes::Places{};
    const RayOnFilm on_pixels(picture_.density, picture_.settings.sensor, landings.at, time);
    if (places.count == 0 && !on_pixels.in_reach()) return;
    const Spectrum light =
        flare_light(picture_.scene, picture_.camera, picture_.settings.path, *path, sampler, work.counters.rays) *
        float(1 / (path->density * per_sample_ * scale_));
    if (light.is_black()) return;
    const auto sample = std::uint32_t(double(index) / picture_.settings.scatter.per_sample);
    if (places.count > 0) nodes_->add(work.arrivals, places, path->wavelengths, light, sample);
    if (on_pixels.in_reach())
        on_pixels.splat(picture_.film, light, path->wavelengths, u_pixel, sample, Layer::flare);
}

}  // namespace dg
