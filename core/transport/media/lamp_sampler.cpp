#include "transport/media/lamp_sampler.h"

#include <cmath>

#include "light/light_segment.h"
#include "transport/media/phase_bsdf.h"

namespace dg {
namespace {

constexpr float kEquiangularShare = 0.9f;

}  // namespace

/// Chooses the lamp by its contribution to the whole segment, then a distance, then a point on the lamp as seen from
/// there.
LampSample LampSampler::sample(float light_samples_per_collision, const Random& u) const {
    const LightSet& lights = path_.scene.lights();
    const Ray& ray = path_.walk.ray;
    LampSample lamp{};
    const LightSegment lit{start(), ray.direction, segment_.length(), segment_.medium().extinction.min(),
                           phase_.angles()};
    const auto choice = lights.choose(u.select, lit);
    if (!choice) return lamp;
    const auto [t, density] = place(lights.place_of(choice->light, u.place, ray.time), u.where);
    lamp.t = ray.t_min + t;
    const SurfaceHit at = in_medium(ray, lamp.t);
    auto light = lights.sample_one(choice->light, u.place, at.position, at.time, path_.wavelengths);
    if (!light || !(light->pdf > 0) || !(density > 0)) return lamp;
    lamp.direct.light = *light;
    const Evaluation f = lamp.direct.f = PhaseBsdf{phase_}.evaluate_with_pdf(at.wo, light->wi);
    lamp.scattering = segment_.medium().scattering * segment_.transmittance_to(t);
    const float pdf_from_point = lights.choice_probability(choice->light, at.position) * light->pdf;
    const float share = light->delta ? 1 : light_share(light_samples_per_collision * pdf_from_point, f.pdf);
    const float weight = share / (choice->probability * density * light->pdf);
    const float worth = (lamp.scattering * f.f_cos * light->radiance).average() * weight;
    if (worth > 0 && std::isfinite(worth)) lamp.direct.weight = weight;
    return lamp;
}

Vec3f LampSampler::start() const { return in_medium(path_.walk.ray, path_.walk.ray.t_min).position; }

/// MIS weight of light sampling against phase function sampling.
float LampSampler::light_share(float light_pdf, float phase_pdf) const {
    using Strategy = PathSettings::Strategy;
    if (path_.settings.strategy == Strategy::bsdf) return 0;
    return path_.settings.strategy == Strategy::light ? 1 : power_heuristic(light_pdf, phase_pdf);
}

/// Samples a distance along the segment, for a lamp.
LampSampler::Place LampSampler::place(const std::optional<LightSet::Place>& lamp, float u) const {
    using Distances = PathSettings::Distances;
    std::optional<Equiangular> equiangular;
    if (lamp) {
        const Vec3f from = start(), direction = path_.walk.ray.direction;
        RayPart lit{0, segment_.length()};
        if (length_squared(lamp->normal) > 0)
            lit = lit.before_plane(dot(lamp->normal, from - lamp->position), dot(lamp->normal, direction));
        if (!lit.empty()) equiangular.emplace(from, direction, lit, lamp->position, phase_.angles());
    }
    const Distances distances = path_.settings.distances;
    float share = distances == Distances::both ? kEquiangularShare : float(distances == Distances::equiangular);
    if (!equiangular || !equiangular->usable()) share = 0;
    const float t = u < share ? equiangular->sample(u / share) : segment_.collision((u - share) / (1 - share));
    const float by_free_path = share < 1 ? (1 - share) * segment_.collision_density(t) : 0;
    return {t, by_free_path + (share > 0 ? share * equiangular->pdf(t) : 0)};
}

}  // namespace dg
