// flare_splat.h -- the light of one path through the lens's reflections or by its own parts, added to the pixels that
// it reaches: what flare and scatter passes end with.
#pragma once
#include <span>

#include "render/flare/flare_aim.h"
#include "render/pass.h"
#include "render/ray_on_film.h"

namespace dg {

/// `density`: of such paths, with all factors. `u_pixel`, `sampler`: random numbers for the film and for what follows
/// in the world. `sample`: index of the samples that the path belongs to. `rays` counts.
inline void splat_flare(const Picture& picture, const FlareArrival& path, double density,
                        std::span<const Reprojection> landings, Vec2f u_pixel, const PathSampler& sampler,
                        std::uint32_t sample, std::uint64_t& rays) {
    const RayOnFilm film_ray(picture.density, picture.settings.sensor, landings, path.lens.ray.time);
    if (!film_ray.in_reach()) return;
    const Spectrum light = flare_light(picture.scene, picture.camera, picture.settings.path, path, sampler, rays);
    if (light.is_black()) return;
    film_ray.splat(picture.film, light * float(1 / density), path.wavelengths, u_pixel, sample, Film::Layer::flare);
}

}  // namespace dg
