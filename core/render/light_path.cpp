#include "render/light_path.h"

#include <cmath>

namespace dg {
namespace {

constexpr int kSequence = -2;            // beside that of paths straight to the lens
constexpr float kRouletteThreshold = 0.3f;   // of the flux at the start

}  // namespace

struct LightPaths::Walk {
    EmissionRay emission;
    PathSampler sampler;
    Moment moment;
    Light light{};             // that it left; unused of the environment
    bool delta = false;
    Ray ray{};
    Spectrum flux{0.f}, start{0.f};
    double odds = 0;           // the ratio of bounce_share.h so far, from the light on
    int vertices = 0;
    float straight = 0;        // m from the last vertex or the light, through windows
    float unknown = 0;         // m within whatever the light is in
    VolumeWalk volume{VolumeWalk::Where::unknown};
    Wavelengths wavelengths{};
    std::uint32_t sample = 0;

    float distance() const {
        return infinite() ? std::numeric_limits<float>::infinity() : straight;
    }
    /// Share of its light that a finite range leaves, at the first vertex.
    float reach() const { return vertices == 0 ? range_attenuation(light, straight) : 1; }
    bool infinite() const {
        return emission.light == LightSet::kEnvironment ||
               std::holds_alternative<DirectionalLight>(light);
    }
};

LightPaths::LightPaths(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                       const LightWeight& weight)
    : scene_(scene), camera_(camera), settings_(settings), weight_(weight) {
    end_secondary_ = settings.dispersion == Dispersion::end_secondary &&
                     std::holds_alternative<ExactLens>(camera.lens);
}

void LightPaths::follow(std::uint64_t index, std::vector<LightArrival>& arrivals,
                        std::uint64_t& rays) const {
    auto walk = begin(index);
    while (walk && is_traceable(walk->ray)) {
        ++rays;
        if (!bounce(*walk, arrivals)) break;
    }
}

/// Time, wavelengths and direction, the choice of the light, the point on it.
std::optional<LightPaths::Walk> LightPaths::begin(std::uint64_t index) const {
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index),
                        settings_.seed);
    const CameraRandom u = sampler.camera();
    const Moment moment = settings_.shutter.draw_any(u.time);
    const auto emitted =
        weight_.emission_rays().sample(u.film.x, sampler.next_2d(), u.lens, moment.time);
    if (!emitted) return std::nullopt;
    Walk walk{*emitted, sampler, moment};
    const auto leaving = scene_.leave(*emitted, moment.time);
    if (!(max_component(leaving.value) > 0)) return std::nullopt;
    walk.ray = leaving.ray;
    if (emitted->light != LightSet::kEnvironment) {
        walk.light = scene_.lights().light_at(emitted->light, moment.time);
        walk.delta = !std::holds_alternative<TriangleLight>(walk.light) &&
                     !std::holds_alternative<SphereLight>(walk.light);
    }
    walk.wavelengths = Wavelengths::sample(u.lambda);
    if (end_secondary_) walk.wavelengths.end_secondary();
    walk.flux = walk.wavelengths.emission(leaving.value) * (1 / emitted->pdf);
    walk.start = walk.flux;
    walk.odds = weight_.of_bounced(emitted->pdf);
    walk.sample = std::uint32_t(double(index) / settings_.light.m2);
    return walk;
}

/// To the next surface, and on. False: the path ends.
bool LightPaths::bounce(Walk& walk, std::vector<LightArrival>& arrivals) const {
    const float u_lobe = walk.sampler.next_1d();
    const Vec2f u_direction = walk.sampler.next_2d(), u_lens = walk.sampler.next_2d(),
                u_pixel = walk.sampler.next_2d();
    const auto found = scene_.intersect(walk.ray);
    if (!found || found->sphere_light >= 0) return false;
    const SurfaceHit& hit = found->surface;
    const bool last = walk.vertices == settings_.path.max_depth;   // behind it only windows count
    if (last && !scene_.has_clear()) return false;
    if (walk.volume.where == VolumeWalk::Where::unknown) walk.unknown += hit.t;
    if (walk.volume.where == VolumeWalk::Where::inside)
        walk.flux *= walk.volume.interior.transmittance(hit.t);
    walk.straight += hit.t;
    const MaterialAt material = scene_.material(hit);
    TwoWay both(material, scene_.textures(), hit, walk.wavelengths);
    // Direct light is left to the camera's paths.
    if (!last && walk.vertices > 0 && !is_specular(both.seen_from(hit.wo))) connect(walk, both, hit, u_lens, u_pixel, arrivals);
    const auto step = both.step(hit.wo, u_lobe, u_direction);
    if (!step || !advance(walk, both, hit, *step)) return false;
    if (last && walk.straight == 0) return false;
    const float strength = (walk.flux / walk.start).max();
    const float survival = strength / kRouletteThreshold, u = walk.sampler.next_1d();
    if (survival < 1) {
        if (!(u < survival)) return false;
        walk.flux *= 1 / survival;
    }
    return true;
}

/// The way on from a surface into what lies beyond it along `w`: what was absorbed on the way there, if a
/// light was within a volume and it is left only now. Empty: see volume_walk.h.
std::optional<Spectrum> LightPaths::enter(const Walk& walk, VolumeWalk& volume, const Bsdf& bsdf,
                                          const SurfaceHit& hit, Vec3f w) const {
    const bool entering = dot(w, hit.ng) < 0;
    if (entering != hit.front) return 1.f;   // reflected
    return std::visit(
        [&](const auto& b) -> std::optional<Spectrum> {
            if (!b.bounds_volume()) return 1.f;
            Spectrum left{1.f};
            if (volume.where == VolumeWalk::Where::unknown && !entering) {
                if (walk.infinite()) return std::nullopt;
                left = b.interior().transmittance(walk.unknown);
            }
            if (!volume.cross(b.interior(), entering)) return std::nullopt;
            return left;
        },
        bsdf);
}

/// Density of the camera's techniques toward the light, per projected solid angle. A point light is found by
/// its choice alone: what its rays have per sr, EmissionRays::pdf() has per m2 at the first vertex.
double LightPaths::camera_density(const Walk& walk, const SurfaceHit& hit, float bsdf_pdf) const {
    double pdf = bsdf_pdf;
    if (walk.vertices == 0) {
        const float by_choice = scene_.lights().pdf(walk.emission.light, hit.position, hit.wo,
                                                    walk.distance(), hit.time);
        pdf = !walk.delta       ? pdf + by_choice
              : walk.infinite() ? by_choice
                                : double(by_choice) * walk.straight * walk.straight;
    }
    return pdf / std::abs(double(dot(hit.ng, hit.wo)));
}

/// Sends light from a vertex to the lens.
void LightPaths::connect(const Walk& walk, TwoWay& both, const SurfaceHit& hit, Vec2f u_lens,
                         Vec2f u_pixel, std::vector<LightArrival>& arrivals) const {
    const Affine3d to_camera = inverse(weight_.pose(walk.ray.time));
    const auto lens =
        weight_.pupil().sample(to_camera.point(to_double(hit.position)), 1, u_lens, walk.ray.time);
    if (!lens || !(lens->pdf > 0)) return;
    LightArrival arrival;
    arrival.lens.ray = Ray{.origin = lens->origin, .direction = lens->direction, .time = walk.ray.time};
    const Ray world = to_world(camera_, arrival.lens.ray);
    const Vec3f w = -world.direction;
    const Scattering s = both.scattering(w, hit.wo);
    if (s.f_cos.is_black() || s.hero_only) return;
    VolumeWalk volume = walk.volume;
    const auto left = enter(walk, volume, both.seen_from(w), hit, w);
    if (!left || volume.where == VolumeWalk::Where::inside) return;
    const double cosine = std::abs(double(dot(hit.ng, w)));
    arrival.density =
        walk.odds * lens->pdf / (cosine * camera_density(walk, hit, s.camera_pdf));
    if (!(arrival.density > 0) || !std::isfinite(arrival.density)) return;
    const double turned = cosine / std::abs(double(dot(hit.ng, hit.wo)));
    arrival.radiance = walk.flux * s.f_cos * *left *
                    float(walk.reach() * turned / lens->pdf * arrival.density / weight_.of_bounced(1));
    arrival.shadow = spawn_ray(hit, w, walk.ray.time);
    arrival.shadow.t_max = length(world.origin - arrival.shadow.origin);
    arrival.lens.iris_opening = walk.moment.iris_opening * setting_at(camera_, walk.ray.time).iris_opening;
    arrival.wavelengths = walk.wavelengths;
    arrival.u_pixel = u_pixel;
    arrival.sample = walk.sample;
    arrivals.push_back(arrival);
}

/// Beyond a vertex, or a window. False: the path ends.
bool LightPaths::advance(Walk& walk, TwoWay& both, const SurfaceHit& hit,
                         const LightStep& step) const {
    const Bsdf& bsdf = both.seen_from(step.to_camera);
    const bool bounds = std::visit([](const auto& b) { return b.bounds_volume(); }, bsdf);
    const Vec3f w = step.to_camera;
    if (!(step.specular && step.transmitted && !bounds)) {
        // No path from the camera finds what a delta lobe does with the light of a delta light.
        if (step.specular && walk.delta && walk.vertices == 0) return false;
        const auto left = enter(walk, walk.volume, bsdf, hit, w);
        if (!left) return false;
        walk.flux *= *left * walk.reach();
        if (!step.specular)
            walk.odds *= step.pdf / (std::abs(double(dot(hit.ng, w))) *
                                     camera_density(walk, hit, step.camera_pdf));
        if (!(walk.odds > 0) || !std::isfinite(walk.odds)) return false;
        ++walk.vertices;
        walk.straight = 0;
    }
    walk.flux *= step.weight;
    walk.ray = spawn_ray(hit, w, walk.ray.time);
    return true;
}

}  // namespace dg
