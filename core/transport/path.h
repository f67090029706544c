// path.h -- radiance along a ray, by path tracing. Independent of camera and film, so furnace tests need neither.
#pragma once
#include <cstdint>

#include "geometry/ray.h"
#include "math/sampler.h"
#include "scene/scene.h"
#include "transport/walk/path_settings.h"
#include "transport/walk/sight.h"

namespace dg {

class FirstRay;   // sharing/first_ray.h

/// Radiance that arrives along `ray`, by path tracing with next-event estimation and multiple importance sampling. The
/// path follows both reflection and refraction at the first smooth clear interfaces (PathSettings::splits). `hit`, if
/// given, receives the first surface. `first`, if given, holds the camera ray's densities for MIS with light paths. In
/// a scene with catchers, only the radiance of objects (Sight::light): catchers and background are dropped.
Radiance radiance(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count,
                  const FirstRay* first = nullptr);

/// radiance() with coverage, and with all three parts of the radiance (Sight) if the scene has catchers. Scenes with
/// catchers cannot use light paths.
Sight trace_camera_ray(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                       const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count,
                       const FirstRay* first = nullptr);

}  // namespace dg
