// path.h -- radiance along a ray. Knows neither camera nor film, so it can be held against a furnace.
#pragma once
#include <cstdint>

#include "geometry/ray.h"
#include "math/sampler.h"
#include "scene/scene.h"
#include "transport/walk/path_settings.h"
#include "transport/walk/sight.h"

namespace dg {

class FirstRay;   // sharing/first_ray.h

/// Radiance that arrives along `ray`, by path tracing with next-event estimation and multiple importance sampling. At
/// the first smooth clear interfaces that it sees, a path goes both ways. `hit`, if given, receives the first surface;
/// `first`, if given, says which share of what emitters send straight along the ray is left to this path.
Radiance radiance(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count,
                  const FirstRay* first = nullptr);

/// The same with coverage, in parts where the scene has catchers. Then light paths must not be in use.
Sight look(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
           const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count, const FirstRay* first = nullptr);

}  // namespace dg
