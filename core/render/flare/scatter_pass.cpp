#include "render/flare/scatter_pass.h"

#include "math/hash.h"
#include "render/flare/flare_splat.h"

namespace dg {
namespace {

constexpr int kSequence = -6;   // where pixels have their row, in the sampler's scramble

}  // namespace

ScatterPass::ScatterPass(const Picture& picture, double per_sample, std::shared_ptr<const ScatterGuide> guide)
    : picture_(picture),
      per_sample_(per_sample),
      scale_(picture.density.integral_of_any_time()),
      guide_(std::move(guide)) {}

void ScatterPass::draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
    for (std::uint64_t i = first; i < last; ++i) draw_one(work.counters, i);
    work.counters.scatter_paths += last - first;
}

/// Order of drawing: source, point of the front, time and wavelengths are stratified together.
void ScatterPass::draw_one(RenderCounters& counters, std::uint64_t index) const {
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index), picture_.settings.seed);
    const CameraRandom u = sampler.camera();
    const FlareAim::Random random{u.film.y, u.lambda, sampler.next_2d(), picture_.settings.shutter.draw_any(u.time)};
    const auto path = guide_->draw(u.film.x, u.lens, random);
    if (!path) return;
    ScatterGuide::Landings landings = guide_->trace(*path, hash64(picture_.settings.seed, index));
    if (guide_->aim().mark_arrived(landings, path->lens.ray.time) == 0) return;
    ++counters.scatter_hits;
    const Vec2f u_pixel = sampler.next_2d();
    splat_flare(picture_, *path, path->density * per_sample_ * scale_, landings, u_pixel, sampler,
                std::uint32_t(double(index) / picture_.settings.scatter.per_sample), counters.rays);
}

}  // namespace dg
