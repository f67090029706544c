#include "transport/media/medium_crossing.h"

#include <algorithm>

#include "math/below_one.h"
#include "medium/tracking.h"
#include "transport/media/phase_bsdf.h"
#include "transport/walk/guides.h"

namespace dg {
namespace {

/// Light samples per collision of a path with throughput 1: on segments that the camera sees directly or through
/// specular bounces, and on other segments. More samples, or resampling among candidates, were measured to cost more
/// time than they save noise (bench/fog.py).
constexpr float kLightSamplesPerCollisionInView = 8, kLightSamplesPerCollision = 0.5f;
/// Expected contribution of a scattered path relative to an unscattered path of the same throughput. It is below 1, as
/// light sampling already adds single scattering.
constexpr float kScatteredWorth = 0.3f;
/// Lower bound of the relative illuminance in roulette: the estimate includes lamps, but neither uniform skies nor
/// emissive media.
constexpr float kLeastLit = 0.1f;

}  // namespace

MediumCrossing::MediumCrossing(PathState& path)
    : path_(path),
      walk_(path.walk),
      medium_(*path.walk.media.around.interior.medium),
      coefficients_(medium_.at(path.wavelengths)) {}

MediumEvent MediumCrossing::cross(float t, bool last) {
    const float before = walk_.unscattered ? walk_.share() : 0;
    MediumEvent event;
    if (medium_.density) cross_grid(t, last, event);
    else cross_homogeneous(t, last, event);
    if (before > 0) {
        const float after = event.kind == MediumEvent::Kind::passed ? walk_.share() : 0;
        path_.sight.covers.add_veil(before - after);
    }
    return event;
}

void MediumCrossing::cross_homogeneous(float t, bool last, MediumEvent& event) {
    const Segment segment(coefficients_, t - walk_.ray.t_min, walk_.media.wavelength_pdfs, path_.wavelengths.secondary_ended);
    if (!coefficients_.emission.is_black()) event.emitted = walk_.throughput * segment.emitted();
    if (last || coefficients_.scattering.is_black() || !(segment.collides() > 0)) {
        walk_.throughput *= segment.transmittance_to(segment.length());
        if (!walk_.throughput.is_black()) event.kind = MediumEvent::Kind::passed;
        return;
    }
    const float fraction = scattering_fraction(segment);
    sample_lamp(segment, fraction, event);
    const float u = path_.sampler.next_1d(), probability = fraction * segment.collides();
    const bool scattered = u < probability;
    const float free_path = scattered ? segment.free_collision(std::min(u / probability, kBelowOne)) : 0;
    if (!take(scattered ? segment.scattered(free_path, fraction) : segment.passed(fraction))) return;
    if (scattered) scatter(free_path, event);
    else event.kind = MediumEvent::Kind::passed;
}

/// Fraction of collisions at which the path is scattered; at the others it passes with a lower weight. On segments that
/// the camera sees the fraction is small in thin media and near 1 in dense media. On other segments it is 1, since
/// weights would multiply along long paths.
float MediumCrossing::scattering_fraction(const Segment& segment) const {
    if (!walk_.in_view || path_.scene.lights().empty()) return 1;
    const float worth = kScatteredWorth * coefficients_.scattering.average() / coefficients_.extinction.average();
    const float collides = segment.collides();
    return std::min(1.f, worth / (worth * collides + 1 - collides));
}

/// Draws one light sample on the segment, with a probability that is below 1 in thin media. `fraction`: from
/// scattering_fraction().
void MediumCrossing::sample_lamp(const Segment& segment, float fraction, MediumEvent& event) {
    const float share = std::min(1.f, walk_.share());
    const float samples = (walk_.in_view ? kLightSamplesPerCollisionInView : kLightSamplesPerCollision) * share;
    const float chance = std::min(1.f, samples * segment.collides());
    event.light_samples_per_collision = chance / (fraction * segment.collides());
    const float u_chance = path_.sampler.next_1d();
    LampSampler::Random u;
    u.select = path_.sampler.next_1d(), u.where = path_.sampler.next_1d();
    u.place = path_.sampler.next_2d();
    if (u_chance >= chance) return;
    event.lamp = LampSampler(path_, medium_.phase, segment).sample(event.light_samples_per_collision, u);
    if (!(event.lamp.direct.weight > 0)) return;
    event.lamp.direct.weight /= chance;
    event.lamp_throughput = walk_.throughput * event.lamp.scattering;
}

void MediumCrossing::scatter(float free_path, MediumEvent& event) {
    event.t = walk_.ray.t_min + free_path;
    const SurfaceHit at = in_medium(walk_.ray, event.t);
    const float u_lobe = path_.sampler.next_1d();
    const auto sample = PhaseBsdf{medium_.phase}.sample(at.wo, u_lobe, path_.sampler.next_2d());
    event.wi = sample->wi;
    event.phase_pdf = sample->pdf;
    note_medium(path_);
    if (survives_dark(walk_.ray.origin, at.position)) event.kind = MediumEvent::Kind::direction_sampled;
}

/// Russian roulette of a path that is scattered `at` a point, by its throughput and by the illuminance there relative
/// to the highest illuminance along the path. Otherwise every path in endless fog would run to max_depth.
bool MediumCrossing::survives_dark(Vec3f from, Vec3f at) {
    const LightSet& lights = path_.scene.lights();
    const float now = lights.illuminance(at);
    float& brightest = walk_.media.brightest;
    brightest = std::max({brightest, lights.illuminance(from), now});
    const float lit = brightest > 0 ? std::max(kLeastLit, now / brightest) : 1;
    const float survival = walk_.strength() * lit;
    if (!(survival < 1)) return true;
    if (path_.sampler.next_1d() >= survival) return false;
    walk_.throughput *= 1 / survival;
    return true;
}

void MediumCrossing::cross_grid(float t, bool last, MediumEvent& event) {
    const GridRay ray = path_.scene.grid_ray(walk_.media.around.interior, walk_.ray);
    const RayRandom random(walk_.ray.origin, walk_.ray.direction, path_.sampler.next_1d());
    const double begin = double(walk_.ray.t_min), end = double(t);
    if (coefficients_.scattering.is_black() && coefficients_.emission.is_black()) {
        walk_.throughput *= ratio_tracking(ray, coefficients_.extinction, begin, end, random);
        if (!walk_.throughput.is_black()) event.kind = MediumEvent::Kind::passed;
        return;
    }
    const Tracked tracked =
        delta_tracking(ray, coefficients_, walk_.media.wavelength_pdfs, path_.wavelengths.secondary_ended, begin, end, random);
    if (!coefficients_.emission.is_black()) event.emitted = walk_.throughput * tracked.emitted;
    if (!take({tracked.weight, tracked.lanes})) return;
    if (!tracked.collided) {
        event.kind = MediumEvent::Kind::passed;
    } else if (!last) {
        note_medium(path_);
        event.kind = MediumEvent::Kind::collision;
        event.t = float(tracked.t);
    }
}

/// False: the throughput is 0.
bool MediumCrossing::take(const Segment::Onward& onward) {
    walk_.throughput *= onward.weight;
    walk_.media.wavelength_pdfs = onward.lanes;
    return !walk_.throughput.is_black();
}

}  // namespace dg
