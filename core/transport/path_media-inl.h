// path_media-inl.h -- part of path.cpp: a path on its way through a participating medium.
//
// In an even medium the light that the way itself emits is a closed form. What lamps send there to be scattered toward
// the path is found in two ways, as light at a surface is: by one light sample at one distance, drawn as the lamp is
// seen from the ray (equiangular.h) or as light is scattered, four to one; and by the path itself, which is scattered
// after a free path and may meet a lamp. With densities n(t) p_lamp and c(t) p_phase, the power heuristic would want
// n / c at the distance. It gets that of distances drawn as light is scattered, 1 / chance of a collision, which both
// know of each other whichever lamp it is: they weigh 1 together, and equiangular distances only improve the first.
// In a grid the path is scattered by delta tracking, and lamps are sampled there.
// Sources: Kulla and Fajardo 2012 (equiangular.h); Wilkie et al. 2014 (segment.h); Pharr, Jakob and Humphreys 2023,
// Physically Based Rendering, chapter 14.
#pragma once
#include "light/light_way.h"
#include "math/below_one.h"
#include "medium/segment.h"
#include "medium/tracking.h"
#include "transport/phase_bsdf.h"

namespace dg {
namespace {

/// Light samples for each scattering of a path that carries all of its light: where the lens looks, and elsewhere. More
/// of them, or the best of several for each, were measured to cost more time than noise (bench/fog.py).
constexpr float kSamplesInView = 8, kSamplesPerCollision = 0.5f;
constexpr float kEquiangularShare = 0.9f;
/// How much a path that is scattered brings, over one that passes with as much light: lamps that its way scatters once
/// are sampled already.
constexpr float kScatteredWorth = 0.3f;
/// Least share of the light at a path's brightest point that any other is believed to get: the estimate knows lamps,
/// and neither even skies nor media that shine.
constexpr float kLeastLit = 0.1f;

/// Point of the ray, in the form of a surface's. No side of it matters.
SurfaceHit in_medium(const Ray& ray, float t) {
    SurfaceHit at;
    at.position = ray.origin + ray.direction * t;
    at.wo = at.ng = at.ns = -ray.direction;
    at.t = t;
    at.time = ray.time;
    return at;
}

/// Goes as far as what the ray meets, `t` m from its origin.
Path::Way Path::cross_medium(float t, int vertex) {
    const Medium& medium = *walk_.medium.medium;
    const MediumAt here = medium.at(wavelengths_);
    const float before = walk_.open ? walk_.throughput.average() * walk_.eta_squared : 0;
    const Way way = medium.density ? cross_grid(medium, here, t, vertex) : cross_even(medium, here, t, vertex);
    if (before > 0) {
        const float after = way == Way::passed ? walk_.throughput.average() * walk_.eta_squared : 0;
        sight_.covers.add_veil(before - after);
    }
    return way;
}

Path::Way Path::cross_even(const Medium& medium, const MediumAt& here, float t, int vertex) {
    const Segment way(here, t - walk_.ray.t_min, walk_.lanes, wavelengths_.secondary_ended);
    if (!here.emission.is_black()) gather(walk_.throughput * way.emitted());
    if (vertex == settings_.max_depth || here.scattering.is_black() || !(way.collides() > 0)) {
        walk_.throughput *= way.left(way.length());
        return walk_.throughput.is_black() ? Way::ended : Way::passed;
    }
    const float drawn = scattering_drawn(way), odds = light_way(medium.phase, way, drawn);
    const float u = sampler_.next_1d(), scatters = drawn * way.collides();
    const bool met = u < scatters;
    const float free_path = met ? way.free_collision(std::min(u / scatters, kBelowOne)) : 0;
    if (!take(met ? way.scattered(free_path, drawn) : way.passed(drawn))) return Way::ended;
    if (!met) return Way::passed;
    const Vec3f from = walk_.ray.origin;
    const SurfaceHit at = in_medium(walk_.ray, walk_.ray.t_min + free_path);
    const PhaseBsdf phase{medium.phase};
    const float u_lobe = sampler_.next_1d();
    const auto sample = phase.sample(at.wo, u_lobe, sampler_.next_2d());
    note_medium();
    walk_.bounces = nullptr;   // no light path is scattered in a medium
    go(phase, at, *sample, nullptr);
    walk_.bsdf_pdf /= odds, walk_.tries = 1;
    return survives_dark(from, at.position) ? Way::scattered : Way::ended;
}

/// Share of the collisions at which the path is scattered; at the others it passes, and weighs less. Few where the lens
/// looks and most light passes, all where none does. Elsewhere all of them: weights would multiply along long paths.
float Path::scattering_drawn(const Segment& way) const {
    if (!walk_.in_view || scene_.lights().empty()) return 1;
    const float worth = kScatteredWorth * way.medium().scattering.average() / way.medium().extinction.average();
    const float met = way.collides();
    return std::min(1.f, worth / (worth * met + 1 - met));
}

/// Russian roulette of a path that is scattered `at` a point: by what it carries, and by what lamps bring there over
/// what they bring to the brightest point of its ways. Endless fog would otherwise keep each path to its last vertex.
bool Path::survives_dark(Vec3f from, Vec3f at) {
    const LightSet& lights = scene_.lights();
    const float now = lights.illuminance(at);
    walk_.brightest = std::max({walk_.brightest, lights.illuminance(from), now});
    const float lit = walk_.brightest > 0 ? std::max(kLeastLit, now / walk_.brightest) : 1;
    const float survival = walk_.throughput.max() * walk_.eta_squared * lit;
    if (!(survival < 1)) return true;
    if (sampler_.next_1d() >= survival) return false;
    walk_.throughput *= 1 / survival;
    return true;
}

Path::Way Path::cross_grid(const Medium& medium, const MediumAt& here, float t, int vertex) {
    const GridRay ray = scene_.grid_ray(walk_.medium, walk_.ray);
    const RayRandom random(walk_.ray.origin, walk_.ray.direction, sampler_.next_1d());
    const double begin = double(walk_.ray.t_min), end = double(t);
    if (here.scattering.is_black() && here.emission.is_black()) {
        walk_.throughput *= ratio_tracking(ray, here.extinction, begin, end, random);
        return walk_.throughput.is_black() ? Way::ended : Way::passed;
    }
    const Tracked way =
        delta_tracking(ray, here, walk_.lanes, wavelengths_.secondary_ended, begin, end, random);
    if (!here.emission.is_black()) gather(walk_.throughput * way.emitted);
    if (!take({way.weight, way.lanes})) return Way::ended;
    if (!way.scattered) return Way::passed;
    if (vertex == settings_.max_depth) return Way::ended;
    note_medium();
    walk_.bounces = nullptr;
    const SurfaceHit at = in_medium(walk_.ray, float(way.t));
    return leave(PhaseBsdf{medium.phase}, at, vertex, nullptr) ? Way::scattered : Way::ended;
}

/// False: the path carries nothing any more.
bool Path::take(const Segment::Onward& onward) {
    walk_.throughput *= onward.weight;
    walk_.lanes = onward.lanes;
    return !walk_.throughput.is_black();
}

/// The guides that a denoiser sees where the path is scattered first: a white that has no normal.
void Path::note_medium() {
    if (!first_hit_ || walk_.seen) return;
    const float share = walk_.throughput.average();
    first_hit_->seen_albedo = first_hit_->seen_albedo + Rgb{share, share, share};
    walk_.seen = true;
}

/// Adds what one light sample brings to one place on the way. Returns the odds of such a sample over a collision of the
/// path (drawn at a share of them), for whatever that meets: fewer than one sample where little can be scattered.
float Path::light_way(const Phase& phase, const Segment& way, float drawn) {
    const float carried = std::min(1.f, walk_.throughput.average() * walk_.eta_squared);
    const float samples = (walk_.in_view ? kSamplesInView : kSamplesPerCollision) * carried;
    const float chance = std::min(1.f, samples * way.collides()), odds = chance / (drawn * way.collides());
    const float u_chance = sampler_.next_1d();
    WayRandom u;
    u.select = sampler_.next_1d(), u.where = sampler_.next_1d();
    u.place = sampler_.next_2d();
    if (u_chance >= chance) return odds;
    const LampOnWay lamp = find_lamp(phase, way, odds, u);
    if (!(lamp.weight > 0)) return odds;
    const Spectrum before = walk_.throughput;
    walk_.throughput *= lamp.scattered;
    arriving(PhaseBsdf{phase}, in_medium(walk_.ray, lamp.t), lamp.light, lamp.weight / chance, lamp.seen, nullptr);
    walk_.throughput = before;
    return odds;
}

/// A sample of a lamp and of a place on the way. The lamp is chosen by what it brings to the whole way, and sampled
/// from the place; weight 0: it brings nothing.
Path::LampOnWay Path::find_lamp(const Phase& phase, const Segment& way, float odds, const WayRandom& u) const {
    const LightSet& lights = scene_.lights();
    LampOnWay lamp{};
    const LightWay seen_by{in_medium(walk_.ray, walk_.ray.t_min).position, walk_.ray.direction, way.length(),
                           way.medium().extinction.min(), phase.angles()};
    const auto choice = lights.choose(u.select, seen_by);
    if (!choice) return lamp;
    const auto [t, density] = aim(way, lights.place_of(choice->light, u.place, walk_.ray.time), phase, u.where);
    lamp.t = walk_.ray.t_min + t;
    const SurfaceHit at = in_medium(walk_.ray, lamp.t);
    auto light = lights.sample_one(choice->light, u.place, at.position, at.time, wavelengths_);
    if (!light || !(light->pdf > 0) || !(density > 0)) return lamp;
    if (light->uneven) scene_.resolve(*light, at.time, wavelengths_);
    lamp.light = *light;
    lamp.seen = PhaseBsdf{phase}.evaluate_with_pdf(at.wo, light->wi);
    lamp.scattered = way.medium().scattering * way.left(t);
    const float as_seen = lights.choice_probability(choice->light, at.position) * light->pdf;
    const float share = light->delta ? 1 : share_of_light(odds * as_seen, lamp.seen.pdf);
    const float weight = share / (choice->probability * density * light->pdf);
    const float worth = (lamp.scattered * lamp.seen.f_cos * light->radiance).average() * weight;
    if (worth > 0 && std::isfinite(worth)) lamp.weight = weight;
    return lamp;
}

/// Share of light sampling in light that both it and the path may find.
float Path::share_of_light(float light_pdf, float phase_pdf) const {
    using Strategy = PathSettings::Strategy;
    if (settings_.strategy == Strategy::bsdf) return 0;
    return settings_.strategy == Strategy::light ? 1 : power_heuristic(light_pdf, phase_pdf);
}

/// A distance at which the lamp lights the way, and its density.
Path::Place Path::aim(const Segment& way, const std::optional<LightSet::Place>& lamp, const Phase& phase,
                      float u) const {
    using Distances = PathSettings::Distances;
    std::optional<Equiangular> seen;
    if (lamp) {
        const Vec3f start = in_medium(walk_.ray, walk_.ray.t_min).position, direction = walk_.ray.direction;
        RayPart lit{0, way.length()};
        if (length_squared(lamp->normal) > 0)
            lit = lit.before_plane(dot(lamp->normal, start - lamp->position), dot(lamp->normal, direction));
        if (!lit.empty()) seen.emplace(start, direction, lit, lamp->position, phase.angles());
    }
    float share = settings_.distances == Distances::both ? kEquiangularShare
                                                         : float(settings_.distances == Distances::equiangular);
    if (!seen || !seen->usable()) share = 0;
    const float t = u < share ? seen->sample(u / share) : way.collision((u - share) / (1 - share));
    const float even = share < 1 ? (1 - share) * way.collision_density(t) : 0;
    return {t, even + (share > 0 ? share * seen->pdf(t) : 0)};
}

}  // namespace
}  // namespace dg
