// walk.h -- state of a camera path from vertex to vertex. Whoever branches a path saves and restores all of it.
//
// A window is a clear sheet or the boundary of a medium: the ray goes straight on. Windows are no vertices.
#pragma once
#include "geometry/ray.h"
#include "material/bsdf_sample.h"
#include "spectrum/sampled_spectrum.h"
#include "transport/sharing/shared_light.h"

namespace dg {

/// The last vertex, at first the lens. It gives the weight of an emitter that the ray meets.
struct LastVertex {
    Vec3f position;       // m
    float bsdf_pdf = 0;   // with which its BSDF chose the ray's direction, 1/sr
    int tries = 1;        // light samples from which one was picked there
    bool delta = true;    // the lens or a delta lobe: light sampling there cannot find what the ray meets
    float windows = 0;    // m from there to the ray's origin, through windows; 0: the ray starts there

    bool is_ray_origin() const { return windows == 0; }
};

/// The path's part in volumes and media.
struct MediaWalk {
    Interior interior;       // fills the space around the path
    float brightest = 0;     // illuminance by lamps at the brightest point of its ways through media, lux
    Spectrum lanes{1.f};     // odds of each wavelength to have drawn the path (medium/segment.h)
};

struct Walk {
    Ray ray;
    Spectrum throughput{1.f};
    float eta_squared = 1;     // undoes the radiance scaling of refraction for Russian roulette
    LastVertex last;
    MediaWalk media;
    SharedLight sharing;
    int splits = 0;            // interfaces at which both ways were taken
    bool in_view = true;       // straight from the camera, or by way of mirrors and smooth glass alone
    bool open = true;          // straight from the camera: what the path meets covers the background
    bool hero_only = false;    // it follows the hero wavelength alone, behind a dispersive interface
    bool guided = false;       // a surface that is not smooth has given the denoiser's guides

    /// Share of the camera ray's light that comes by this way.
    float share() const { return throughput.average() * eta_squared; }
    /// The most that any wavelength carries.
    float strength() const { return throughput.max() * eta_squared; }
};

/// False: the path ends. Only paths that carry less than kThreshold are at stake (without the 1/eta^2 of radiance
/// inside glass): ending stronger ones saves little and was measured to cost more noise than time. The paths that
/// survive carry the light of those that end, so that the mean does not change.
inline bool survives_roulette(Walk& walk, float u) {
    constexpr float kThreshold = 0.3f;
    const float strength = walk.strength();
    if (strength >= kThreshold) return true;
    const float survival = strength / kThreshold;
    if (u >= survival) return false;
    walk.throughput *= 1.f / survival;
    return true;
}

}  // namespace dg
