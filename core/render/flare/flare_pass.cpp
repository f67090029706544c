#include "render/flare/flare_pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "render/ray_on_film.h"

namespace dg {
namespace {

constexpr int kSequence = -4;   // in place of a pixel row, in the sampler's scramble
constexpr float kFarthestPx = 1e6f;   // outside the frame
constexpr float kMostReach = 2.5f;    // px: for wider filters RayOnFilm chooses a single pixel
constexpr std::size_t kChunk = kLensBatch / kWavelengths;   // paths per call of the lens

}  // namespace

FlarePass::FlarePass(const Picture& picture, double per_sample, std::shared_ptr<const FlareGuide> guide)
    : picture_(picture),
      per_sample_(per_sample),
      scale_(picture.density.integral_of_any_time()),
      guide_(std::move(guide)) {}

/// Draws all paths first, then traces them sorted by ghost: rays through the same surfaces share SIMD lanes.
void FlarePass::draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
    work.paths.clear(), work.u_pixel.clear(), work.sample.clear(), work.samplers.clear();
    for (std::uint64_t i = first; i < last; ++i) begin(work, i);
    work.order.resize(work.paths.size());
    std::iota(work.order.begin(), work.order.end(), 0u);
    const auto kind = [&](std::uint32_t i) {
        const FlareArrival& p = work.paths[i];
        return std::tuple(guide_->aim().state_at(p.lens.ray.time), p.ghost);
    };
    std::ranges::stable_sort(work.order, {}, kind);
    for (std::size_t from = 0; from < work.order.size();) {
        std::size_t to = from;
        while (to < work.order.size() && to - from < kChunk && kind(work.order[to]) == kind(work.order[from]))
            ++to;
        trace(work, from, to);
        from = to;
    }
    work.counters.flare_paths += last - first;
    work.counters.flare_rays += (last - first) * kWavelengths;
}

/// Stratifies pair, point of the front, time and wavelengths jointly.
void FlarePass::begin(Workspace& work, std::uint64_t index) const {
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index), picture_.settings.seed);
    const CameraRandom u = sampler.camera();
    auto path = guide_->draw({u.film.x, u.film.y, u.lambda, u.lens, sampler.next_2d(),
                             picture_.settings.shutter.draw_any(u.time)});
    if (!path) return;
    path->density *= per_sample_ * scale_;
    work.paths.push_back(*path);
    work.u_pixel.push_back(sampler.next_2d());
    work.samplers.push_back(sampler);
    work.sample.push_back(std::uint32_t(double(index) / picture_.settings.flare.per_sample));
}

/// Traces paths of a ghost to the film, each wavelength separately.
void FlarePass::trace(Workspace& work, std::size_t first, std::size_t last) const {
    work.rays.clear(), work.nm.clear();
    for (std::size_t i = first; i < last; ++i) {
        const FlareArrival& path = work.paths[work.order[i]];
        for (int k = 0; k < kWavelengths; ++k)
            work.rays.push_back(path.lens), work.nm.push_back(path.wavelengths.nm[k]);
    }
    work.landings.assign(work.rays.size(), Reprojection{});
    const FlareArrival& any = work.paths[work.order[first]];
    guide_->aim().trace(guide_->aim().state_at(any.lens.ray.time), any.ghost, work.rays, work.nm, work.landings);
    for (std::size_t i = first; i < last; ++i) {
        if (i + 1 < last) prefetch(work, i + 1 - first);
        const std::span own(work.landings.data() + (i - first) * kWavelengths, std::size_t(kWavelengths));
        const float time = work.paths[work.order[i]].lens.ray.time;
        const int arrived = guide_->aim().mark_arrived(own, time);
        work.counters.flare_hits += std::uint64_t(arrived);
        if (arrived > 0) finish(work, work.order[i], own);
    }
}

/// Prefetches the film pixels of a path of the last traced chunk.
void FlarePass::prefetch(const Workspace& work, std::size_t path) const {
    const float reach = picture_.settings.filter.radius();
    if (reach > kMostReach) return;
    for (std::size_t k = path * kWavelengths; k < (path + 1) * kWavelengths; ++k) {
        if (!(work.landings[k].transmittance > 0)) continue;
        const Vec2f px = picture_.settings.sensor.px_from_mm(work.landings[k].film_mm);
        if (!(std::abs(px.x) < kFarthestPx && std::abs(px.y) < kFarthestPx)) continue;
        picture_.film.prefetch(int(std::floor(px.x - reach)), int(std::ceil(px.x + reach)), int(std::floor(px.y - reach)),
                       int(std::ceil(px.y + reach)), Layer::flare);
    }
}

void FlarePass::finish(Workspace& work, std::size_t index, std::span<const Reprojection> landings) const {
    const FlareArrival& path = work.paths[index];
    const RayOnFilm on_film(picture_.density, picture_.settings.sensor, landings, path.lens.ray.time);
    if (!on_film.in_reach()) return;
    const Spectrum light = flare_light(picture_.scene, picture_.camera, picture_.settings.path, path,
                                       work.samplers[index], work.counters.rays);
    if (light.is_black()) return;
    on_film.splat(picture_.film, light * float(1 / path.density), path.wavelengths, work.u_pixel[index],
                  work.sample[index], Layer::flare);
}

}  // namespace dg
