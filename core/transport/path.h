// path.h -- radiance along a ray. Knows neither camera nor film, so it can be held against a furnace.
#pragma once
#include "geometry/ray.h"
#include "math/sampler.h"
#include "scene/scene.h"

namespace dg {

struct PathSettings {
    int max_depth = 16;      // surface vertices
    int roulette_depth = 2;  // vertices before Russian roulette of weak paths
    int splits = 2;          // smooth clear interfaces, seen from where the path starts, of which it takes both ways
    enum class Strategy { mis, light, bsdf } strategy = Strategy::mis;   // light, bsdf: for tests
    bool caustics = true;    // with what mirrors and smooth glass throw on rough surfaces
    bool straight = true;    // with what emitters send straight along the ray, through clear sheets too
};

/// Light in two parts that add up: what any wavelength of the path could have found as its hero, and
/// what was found behind a dispersive interface, where the path went the way of its hero alone (lane 0,
/// with the share of all four already; see hero_alone()).
struct Radiance {
    Spectrum shared{0.f}, hero{0.f};
    Spectrum sum() const { return shared + hero; }
};

/// The first surface on the way, and guides for a denoiser: albedo and normal of what is seen in it. Mirrors and smooth
/// glass show what lies behind them, each way with the share of light that takes it; nothing is 0. So the documentation
/// of Open Image Denoise (Albedos, Normals) recommends it.
struct FirstHit {
    bool found = false;
    Vec3f position, normal, albedo;   // m, world; unit
    std::uint32_t instance = 0;
    Vec3f seen_albedo, seen_normal;   // of the first surface that is not smooth, times that share
};

class FirstRay;   // first_ray.h

/// Radiance that arrives along `ray`, by path tracing with next-event estimation and multiple importance sampling. At
/// the first smooth clear interfaces that it sees, a path goes both ways. `hit`, if given, receives the first surface;
/// `first`, if given, says which share of what emitters send straight along the ray is left to this path.
Radiance radiance(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count,
                  const FirstRay* first = nullptr);

}  // namespace dg
