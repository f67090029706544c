#include "render/flare/glints.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

constexpr std::size_t kMostLamps = 16;
constexpr int kMostBends = 6;
constexpr float kNarrow = 4;   // 1/sr: lobes of at least this density are treated like mirrors

}  // namespace

Glints::Glints(const Scene& scene, const EmitterPoints& sources) : scene_(scene), all_(sources) {
    for (int i = 0; i < sources.count(); ++i)
        if (sources.has_size(i)) sources_.push_back(i);
    std::ranges::stable_sort(sources_, std::ranges::greater{}, [&](int i) { return sources.strength(i); });
    if (sources_.size() > kMostLamps) sources_.resize(kMostLamps);
}

float Glints::seen(Ray ray, float half_angle, Wavelengths wavelengths, PathSampler& sampler,
                   std::uint64_t& rays) const {
    Spectrum throughput{1.f}, light{0.f};
    bool bent = false;
    for (int bends = 0; bends < kMostBends && is_traceable(ray); ++bends) {
        if (bent)
            for (const int source : sources_)
                light += throughput * wavelengths.emission(lamp(source, ray, half_angle, wavelengths, sampler, rays));
        ++rays;
        auto found = scene_.intersect(ray);
        if (!found || found->sphere_light >= 0) break;
        SurfaceHit& hit = found->surface;
        const MaterialAt material = scene_.material(hit);
        const Bsdf bsdf = scene_.shade_smooth(material, hit, wavelengths);
        const float u_lobe = sampler.next_1d();
        const Vec2f u = sampler.next_2d();
        const auto sample =
            std::visit([&](const auto& kind) { return kind.sample(hit.wo, u_lobe, u); }, bsdf);
        if (!sample || sample->weight.is_black() || !(sample->specular || sample->pdf > kNarrow)) break;
        bent |= !(sample->specular && dot(sample->wi, ray.direction) > 1 - 1e-6f);   // not a window
        throughput *= sample->weight;
        ray = spawn_ray(hit, sample->wi, ray.time);
    }
    return wavelengths.to_xyz(light).y;
}

/// Contribution of a point on a lamp.
Rgb Glints::lamp(int source, const Ray& ray, float half_angle, const Wavelengths& wavelengths,
                 PathSampler& sampler, std::uint64_t& rays) const {
    const float u_select = sampler.next_1d();
    const auto from = all_.sample(source, u_select, sampler.next_2d(), ray.time, {ray.origin, 0});
    if (!from) return {0, 0, 0};
    const Vec3f to = from->at_infinity ? from->point.position : from->point.position - ray.origin;
    const float d2 = from->at_infinity ? 1 : length_squared(to);
    if (!(d2 > 0)) return {0, 0, 0};
    const Vec3f way = to * (1 / std::sqrt(d2));
    if (!(dot(way, ray.direction) > std::cos(half_angle))) return {0, 0, 0};
    const float facing = from->at_infinity ? 1 : std::abs(dot(from->point.normal, way));
    const Rgb luminance = scene_.emission(from->point, -way, ray.time);
    if (!(max_component(luminance) > 0)) return {0, 0, 0};
    Ray shadow = ray;   // ends before the lamp, which must not occlude itself
    shadow.direction = way;
    if (!from->at_infinity) shadow.t_max = std::sqrt(d2) * (1 - 1e-3f);
    ++rays;
    if (scene_.visibility_along(shadow, wavelengths).is_black()) return {0, 0, 0};
    const float cone = 2 * kPi * (1 - std::cos(half_angle));
    return luminance * (facing / (d2 * from->point.pdf * cone));
}

}  // namespace dg
