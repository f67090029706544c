#include "transport/emission.h"

#include <cmath>
#include <limits>

#include "transport/walk/direct_light.h"

namespace dg {
namespace {

/// MIS weight of BSDF sampling against light sampling, for an emitter that light sampling at the last vertex finds with
/// the density `light_pdf`. The weight against light paths (LightPathMis) is a separate factor.
float bsdf_weight(const PathState& path, float light_pdf) {
    using Strategy = PathSettings::Strategy;
    const LastVertex& last = path.walk.last;
    if (last.delta || light_pdf <= 0 || path.settings.strategy == Strategy::bsdf) return 1;
    if (path.settings.strategy == Strategy::light) return 0;
    return power_heuristic(last.bsdf_pdf, float(last.candidates) * light_pdf);
}

EmitterMet met(const WalkState& walk, float distance, float light_pdf) {
    const float ratio = walk.last.delta ? 0 : light_pdf / walk.last.bsdf_pdf;
    return {walk.last.position, walk.ray.direction, distance, walk.ray.time, ratio};
}

}  // namespace

Spectrum sky_emission(const PathState& path) {
    const WalkState& walk = path.walk;
    const LightSet& lights = path.scene.lights();
    if (!lights.has_environment()) return walk.throughput * Spectrum(0.f);
    const Vec3f direction = walk.ray.direction;
    const float time = walk.ray.time;
    const Wavelengths& wavelengths = path.wavelengths;
    const auto [radiance, pdf] =
        walk.last.delta ? LightSet::SkyLookup{lights.environment_radiance(direction, time, wavelengths), 0}
                        : lights.lookup_environment(direction, walk.last.position, time, wavelengths);
    const float camera_weight =
        walk.light_mis.off() ? 1
                             : walk.light_mis.weight_of_sky(met(walk, std::numeric_limits<float>::infinity(), pdf));
    return walk.throughput * (radiance * (camera_weight * bsdf_weight(path, pdf)));
}

Spectrum sphere_emission(const PathState& path, std::uint32_t sphere, const SurfaceHit& hit) {
    const WalkState& walk = path.walk;
    const LightSet& lights = path.scene.lights();
    const float pdf = walk.last.delta ? 0 : lights.pdf_sphere(sphere, walk.last.position, hit.time);
    const float distance = walk.last.window_distance + hit.t;
    const float camera_weight =
        walk.light_mis.off() ? 1 : walk.light_mis.weight_of_sphere(lights, sphere, hit, met(walk, distance, pdf));
    return walk.throughput * lights.sphere_radiance(sphere, hit.wo, hit.time, path.wavelengths) *
           (camera_weight * bsdf_weight(path, pdf));
}

Spectrum surface_emission(const PathState& path, const Material& material, const SurfaceHit& hit) {
    const WalkState& walk = path.walk;
    if (!emits(material)) return walk.throughput * Spectrum(0.f);
    SurfaceHit lookup = hit;
    // Light sampling and light paths with bounces look up emission without a footprint. Light paths from an emitter
    // directly to the lens know the cone of the camera's sample, and use its footprint.
    if (!walk.in_view) lookup.footprint[0] = lookup.footprint[1] = {};
    const Rgb luminance = emitted(material, path.scene.textures(), lookup) * path.scene.shaping(material, hit);
    if (max_component(luminance) <= 0) return walk.throughput * Spectrum(0.f);
    const LightSet& lights = path.scene.lights();
    const float distance = walk.last.window_distance + hit.t;
    const float cosine = std::abs(dot(hit.ng, hit.wo));
    const float pdf = walk.last.delta ? 0
                                      : lights.pdf_triangle(hit.instance, hit.primitive, distance, cosine,
                                                            walk.last.position, hit.time);
    const float camera_weight =
        walk.light_mis.off() ? 1 : walk.light_mis.weight_of_triangle(lights, hit, met(walk, distance, pdf));
    return walk.throughput * (path.wavelengths.emission(luminance) * (camera_weight * bsdf_weight(path, pdf)));
}

}  // namespace dg
