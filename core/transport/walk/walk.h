// walk.h -- state of a camera path's random walk. Branching a path saves and restores all of it.
//
// A window is a surface that does not deflect the ray: a clear sheet or the boundary of a medium. The path passes it
// with a new ray, but windows are not counted as vertices.
#pragma once
#include "geometry/ray.h"
#include "scene/solids.h"
#include "spectrum/sampled_spectrum.h"
#include "transport/sharing/light_path_mis.h"

namespace dg {

/// The last vertex, initially the lens. It determines the MIS weight of an emitter that the ray hits.
struct LastVertex {
    Vec3f position;       // m
    float bsdf_pdf = 0;   // density of the ray's direction under BSDF sampling, 1/sr
    int candidates = 1;   // number of light samples drawn at the vertex; a single sample is traced (light_pick.h)
    bool delta = true;    // the lens or a delta lobe: light sampling cannot find emitters along the ray
    float window_distance = 0;   // m from the vertex to the ray's origin, if the ray starts at a window behind it; else 0

    /// Whether the ray starts at the vertex, not at a window behind it.
    bool starts_ray() const { return window_distance == 0; }
};

/// State of a path inside volumes and participating media.
struct MediaState {
    Surroundings around;     // solids and media around the path
    float brightest = 0;     // highest illuminance by lamps along the path inside media, lux
    Spectrum wavelength_pdfs{1.f};   // relative density with which each wavelength draws the path (medium/segment.h)
};

struct WalkState {
    Ray ray;
    Spectrum throughput{1.f};
    float eta_squared = 1;     // undoes the radiance scaling of refraction for Russian roulette
    LastVertex last;
    MediaState media;
    LightPathMis light_mis;
    int splits = 0;            // interfaces at which the path followed both lobes
    bool in_view = true;       // only windows and specular bounces since the camera
    bool unscattered = true;   // only windows, or glass with see_through, since the camera: the next surface counts as coverage
    bool hero_only = false;    // only the hero wavelength is left, behind a dispersive interface
    bool guides_recorded = false;   // the denoiser's guides, at a rough surface

    /// This branch's share of the camera ray's light, without the eta^2 scaling of radiance.
    float share() const { return throughput.average() * eta_squared; }
    /// The largest throughput of any wavelength, without the eta^2 scaling of radiance.
    float strength() const { return throughput.max() * eta_squared; }
};

/// Russian roulette; false: the path ends. Only paths with a throughput below kThreshold (without the 1/eta^2 of
/// radiance inside glass) are candidates: ending stronger paths was measured to add more noise than it saves time.
/// Surviving paths are divided by their survival probability, so the estimate stays unbiased.
inline bool survives_roulette(WalkState& walk, float u) {
    constexpr float kThreshold = 0.3f;
    const float strength = walk.strength();
    if (strength >= kThreshold) return true;
    const float survival = strength / kThreshold;
    if (u >= survival) return false;
    walk.throughput *= 1.f / survival;
    return true;
}

}  // namespace dg
