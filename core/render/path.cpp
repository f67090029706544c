#include "render/path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/bounce_share.h"

namespace dg {
namespace {

constexpr float kRouletteThreshold = 0.3f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Power heuristic with exponent 2. Source: Veach 1997, Robust Monte Carlo Methods, section 9.2.4.
float power_heuristic(float pdf, float other) {
    const float ratio = other / pdf;   // a ratio, as the square of a large pdf overflows
    return 1.f / (1.f + ratio * ratio);
}

/// State of the path from vertex to vertex.
struct Walk {
    Ray ray;
    Spectrum throughput{1.f};
    Vec3f previous;              // where the ray left from, for the density of light sampling
    float bsdf_pdf = 0;
    bool from_delta = true;      // camera, or a mirror: light sampling cannot have found this
    bool in_view = true;         // straight from the camera, or by way of mirrors and smooth glass alone
    float straight = 0;          // m from there to the ray's origin, through clear sheets
    float eta_squared = 1;       // undoes the radiance scaling of refraction for Russian roulette
    Interior medium;
    const FirstRay* first = nullptr;   // while the path is one, and light paths may find the same
    BounceShare* bounces = nullptr;    // while light paths may find what comes next
};

/// Share of emission met by following the BSDF, where light sampling would have had `light_pdf`.
float emission_weight(const Walk& walk, float light_pdf, PathSettings::Strategy strategy) {
    if (walk.from_delta || light_pdf <= 0 || strategy == PathSettings::Strategy::bsdf) return 1;
    if (strategy == PathSettings::Strategy::light) return 0;
    return power_heuristic(walk.bsdf_pdf, light_pdf);
}

/// Share of an emitter that the path has met, which light paths leave.
float bounced_share(const Walk& walk, std::int64_t light, float distance, float light_pdf) {
    if (!walk.bounces) return 1;
    const float ratio = walk.from_delta ? 0 : light_pdf / walk.bsdf_pdf;
    return walk.bounces->of_emitter(light, walk.previous, walk.ray.direction, distance,
                                    walk.ray.time, ratio);
}

Spectrum environment_emission(const Scene& scene, const Walk& walk, const Wavelengths& wl,
                              PathSettings::Strategy strategy) {
    const LightSet& lights = scene.lights();
    if (!lights.has_environment()) return 0.f;
    const float pdf =
        walk.from_delta
            ? 0
            : lights.pdf_environment(walk.ray.direction, walk.previous, walk.ray.time);
    const float left = walk.first ? walk.first->share_of_sky(walk.ray.direction).value_or(1.f)
                                  : bounced_share(walk, LightSet::kEnvironment, kInfinity, pdf);
    return lights.environment_radiance(walk.ray.direction, walk.ray.time, wl) *
           (left * emission_weight(walk, pdf, strategy));
}

Spectrum surface_emission(const Scene& scene, const Walk& walk, const Material& material,
                          const SurfaceHit& hit, const Wavelengths& wl,
                          PathSettings::Strategy strategy) {
    if (!emits(material)) return 0.f;
    SurfaceHit seen = hit;
    // Light that light sampling and light paths could find too must be the same light: that of a point. Light paths
    // straight to the lens know the cone of the camera's sample, and see what it covers.
    if (!walk.in_view) seen.footprint[0] = seen.footprint[1] = {};
    const Rgb luminance = emitted(material, scene.textures(), seen);
    if (max_component(luminance) <= 0) return 0.f;
    const LightSet& lights = scene.lights();
    const float distance = walk.straight + hit.t;
    const float pdf =
        walk.from_delta
            ? 0
            : lights.pdf_triangle(hit.instance, hit.primitive, distance,
                                  std::abs(dot(hit.ng, hit.wo)), walk.previous, hit.time);
    float share = walk.first ? walk.first->share_of_triangle(hit).value_or(1.f) : 1.f;
    if (walk.bounces) {
        const std::int64_t light = lights.triangle_index(hit.instance, hit.primitive);
        if (light >= 0) share *= bounced_share(walk, light, distance, pdf);
    }
    return wl.emission(luminance) * (share * emission_weight(walk, pdf, strategy));
}

/// The cone that leaves a hit. Curvature is asked for only where it matters.
RayCone next_cone(const Scene& scene, const RayCone& cone, const SurfaceHit& hit, const BsdfSample& sample) {
    if (cone.empty()) return cone;
    const RayCone here = cone.after(hit.t);
    if (!sample.specular) return here.scattered(sample.pdf);
    if (!sample.transmitted) return here.reflected(scene.curvature(hit));
    return sample.eta == 1 ? here : here.refracted(scene.curvature(hit), sample.eta);
}

/// The numbers of one vertex.
struct VertexRandom {
    float select = 0;      // which light
    Vec2f light;           // where on it
    float lobe = 0;        // which lobe of the BSDF
    Vec2f direction;
};

/// Every vertex takes the same four dimensions, so that stratification stays; those that this BSDF has
/// no use for are left out.
template <typename BsdfKind>
VertexRandom draw_vertex(const BsdfKind& bsdf, bool lit, PathSampler& sampler) {
    VertexRandom u;
    const bool specular = bsdf.is_specular();
    if (lit && !specular) {
        u.select = sampler.next_1d();
        u.light = sampler.next_2d();
    } else {
        sampler.skip(2);
    }
    if constexpr (BsdfKind::kOneLobe)
        sampler.skip(1);
    else
        u.lobe = sampler.next_1d();
    if (specular)
        sampler.skip(1);
    else
        u.direction = sampler.next_2d();
    return u;
}

/// The medium of a ray that leaves along `wi`.
template <typename BsdfKind>
Interior medium_after(const Walk& walk, const SurfaceHit& hit, const BsdfKind& bsdf,
                      Vec3f wi) {
    const float side = dot(wi, hit.ng);
    const bool transmitted = (side > 0) != hit.front;
    if (!transmitted) return walk.medium;
    return medium_beyond(walk.medium, bsdf.interior(), bsdf.bounds_volume(), side < 0);
}

/// Next-event estimation at one vertex. hero_only: see Evaluation.
template <typename BsdfKind>
Spectrum direct_light(const Scene& scene, const SurfaceHit& hit, const BsdfKind& bsdf,
                      const VertexRandom& u, const Walk& walk, const Wavelengths& wl,
                      BounceShare::Vertex* both, PathSettings::Strategy strategy,
                      bool& hero_only, std::uint64_t& rays) {
    const auto light = scene.sample_light(u.select, u.light, hit.position, hit.time, wl);
    if (!light || light->pdf <= 0) return 0.f;
    if (strategy == PathSettings::Strategy::bsdf && !light->delta) return 0.f;
    const auto [f_cos, pdf, alone_bent] = bsdf.evaluate_with_pdf(hit.wo, light->wi);
    if (f_cos.is_black()) return 0.f;
    hero_only = alone_bent;
    ++rays;
    const Spectrum visible =
        scene.visibility(spawn_ray(hit, light->wi, walk.ray.time), light->distance,
                         light->delta, medium_after(walk, hit, bsdf, light->wi), wl);
    if (visible.is_black()) return 0.f;
    const bool alone = light->delta || strategy == PathSettings::Strategy::light;
    float weight = alone ? 1.f : power_heuristic(light->pdf, pdf);
    if (both) weight *= walk.bounces->of_sample(scene, *both, *light, wl);
    return f_cos * light->radiance * visible * (weight / light->pdf);
}

/// Carries on from a vertex. What goes straight on through a clear sheet comes from where
/// it came from: light sampling there sees through the sheet too.
template <typename BsdfKind>
void advance(Walk& walk, const SurfaceHit& hit, const BsdfKind& bsdf,
             const BsdfSample& sample, BounceShare::Vertex* both) {
    walk.throughput *= sample.weight;
    if (sample.transmitted) {
        walk.eta_squared *= sample.eta * sample.eta;
        walk.medium = medium_after(walk, hit, bsdf, sample.wi);
        if (sample.specular && !bsdf.bounds_volume()) {
            walk.straight += hit.t;
            return;
        }
    }
    walk.first = nullptr;
    if (both) {
        walk.bounces->leave(*both, sample);
        if (!walk.bounces->open()) walk.bounces = nullptr;
    }
    walk.bsdf_pdf = sample.pdf;
    walk.from_delta = sample.specular;
    walk.in_view = walk.in_view && sample.specular;
    walk.previous = hit.position;
    walk.straight = 0;
}

void record_first_hit(const Scene& scene, const Material& material, const SurfaceHit& hit,
                      AovSample& aov) {
    aov.hit = true;
    aov.position = hit.position;
    aov.normal = hit.ns;
    aov.albedo = albedo(material, scene.textures(), hit);
    aov.object_id = hit.instance + 1;
}

/// False: the path ends. Only paths that carry less than kRouletteThreshold are at stake (without the
/// 1/eta^2 of radiance inside glass): ending stronger ones saves little and was measured to cost more
/// noise than time. What survives is raised by what was ended, so that the mean does not change.
bool survives_roulette(Walk& walk, float u) {
    const float strength = walk.throughput.max() * walk.eta_squared;
    if (strength >= kRouletteThreshold) return true;
    const float survival = strength / kRouletteThreshold;
    if (u >= survival) return false;
    walk.throughput *= 1.f / survival;
    return true;
}

}  // namespace

Radiance radiance(const Scene& scene, Ray ray, Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, AovSample* aov, std::uint64_t* ray_count,
                  const FirstRay* first) {
    Radiance light;
    Spectrum* gathered = &light.shared;
    Walk walk;
    walk.ray = ray;
    walk.previous = ray.origin;
    walk.first = first;
    std::optional<BounceShare> bounces;
    if (first) bounces.emplace(*first);
    if (bounces && bounces->open()) walk.bounces = &*bounces;
    std::uint64_t rays = 0;
    for (int vertex = 0;; vertex += walk.straight == 0) {  // a window is no vertex
        if (!is_traceable(walk.ray))   // the film counts the sample as bad; the ray tracer never sees it
            return {Spectrum(std::numeric_limits<float>::quiet_NaN()), 0.f};
        ++rays;
        const bool caustic = walk.from_delta && !walk.in_view;
        const bool counts = (settings.straight || vertex > 0) && (settings.caustics || !caustic);
        auto found = scene.intersect(walk.ray);
        if (!found) {
            if (counts)
                *gathered += walk.throughput *
                             environment_emission(scene, walk, wavelengths, settings.strategy);
            break;
        }
        SurfaceHit& hit = found->surface;
        if (walk.medium.present) walk.throughput *= walk.medium.transmittance(hit.t);
        if (found->sphere_light >= 0) {
            if (!counts) break;
            const auto sphere = std::uint32_t(found->sphere_light);
            const float pdf = walk.from_delta ? 0
                                              : scene.lights().pdf_sphere(
                                                    sphere, walk.previous, hit.time);
            const float left =
                walk.first ? walk.first->share_of_sphere(sphere, hit).value_or(1.f)
                           : bounced_share(walk, scene.lights().sphere_index(sphere),
                                           walk.straight + hit.t, pdf);
            *gathered += walk.throughput *
                         scene.lights().sphere_radiance(sphere, hit.time, wavelengths) *
                         (left * emission_weight(walk, pdf, settings.strategy));
            break;
        }
        const MaterialAt material = scene.material(hit);
        if (counts)
            *gathered += walk.throughput * surface_emission(scene, walk, material, hit, wavelengths,
                                                            settings.strategy);
        const bool last = vertex == settings.max_depth;  // behind it only windows count
        if (last && !scene.has_clear()) break;

        SurfaceHit bare;
        if (walk.bounces) bare = hit;
        const Bsdf bsdf = shade(material, scene.textures(), hit, wavelengths);
        std::optional<BounceShare::Vertex> both;
        if (walk.bounces) both.emplace(scene, material, bare, wavelengths, bsdf);
        if (aov && !aov->hit) record_first_hit(scene, material, hit, *aov);
        const bool alive = std::visit(
            [&](const auto& kind) {
                const VertexRandom u = draw_vertex(kind, !scene.lights().empty(), sampler);
                if (!last && !kind.is_specular()) {
                    bool hero_only = false;
                    const Spectrum direct =
                        walk.throughput * direct_light(scene, hit, kind, u, walk, wavelengths,
                                                       both ? &*both : nullptr,
                                                       settings.strategy, hero_only, rays);
                    (hero_only ? light.hero : *gathered) += direct;
                }
                const auto sample = kind.sample(hit.wo, u.lobe, u.direction);
                if (!sample || sample->weight.is_black()) return false;
                advance(walk, hit, kind, *sample, both ? &*both : nullptr);
                if (last && walk.straight == 0) return false;
                if (sample->hero_only) {
                    // The throughput carries the hero's share from here on, so the weights of what was
                    // gathered before stay. A BSDF disperses no path whose wavelengths have ended.
                    wavelengths.secondary_ended = true;
                    gathered = &light.hero;
                }
                const RayCone cone = next_cone(scene, walk.ray.cone, hit, *sample);
                walk.ray = spawn_ray(hit, sample->wi, walk.ray.time);
                walk.ray.cone = cone;
                return true;
            },
            bsdf);
        if (!alive) break;
        if (vertex + 1 >= settings.roulette_depth &&
            !survives_roulette(walk, sampler.next_1d()))
            break;
    }
    if (ray_count) *ray_count += rays;
    return light;
}

}  // namespace dg
