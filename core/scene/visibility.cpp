// visibility.cpp -- transmittance of shadow rays through clear surfaces.
#include <algorithm>
#include <tuple>

#include "scene/scene.h"

namespace dg {
namespace {

/// Ends the ray before a light, by more than the error of the point on it.
void stop_before(Ray& ray, float distance) {
    if (!(distance < std::numeric_limits<float>::infinity())) return;
    const Vec3f from = ray.origin, end = from + ray.direction * distance;
    const float largest = std::max(largest_coordinate(from), largest_coordinate(end));
    ray.t_max = distance - (1e-4f * distance + 0x1p-19f * largest);
}

}  // namespace

Spectrum Scene::visibility(Ray ray, bool delta, const Interior& medium, const Wavelengths& wavelengths) const {
    const float distance = ray.t_max;
    stop_before(ray, distance);
    if (ray.t_max <= 0) return 1.f;
    return transmission(ray, distance, delta, medium, wavelengths);
}

Spectrum Scene::visibility_along(const Ray& ray, const Wavelengths& wavelengths) const {
    if (ray.t_max < 0) return 0.f;
    if (!(ray.t_max > ray.t_min)) return 1.f;
    return transmission(ray, ray.t_max, false, has_media_ ? medium_around(ray) : Interior{}, wavelengths);
}

Spectrum Scene::transmission(const Ray& ray, float distance, bool delta, const Interior& medium,
                             const Wavelengths& wavelengths) const {
    if (!has_clear_ && !medium.present && !medium.medium) return intersector_->occluded(ray) ? 0.f : 1.f;
    Crossings crossings(delta);
    if (intersector_->occluded(ray, &crossings)) return 0.f;
    return through_crossings(ray, crossings, medium, distance, wavelengths);
}

/// Processes crossings in the order in which a path would hit them. Crossings closer than the offset of spawn_ray are
/// duplicates of the same surface.
Spectrum Scene::through_crossings(const Ray& ray, Crossings& crossings, Interior medium,
                                  float distance, const Wavelengths& wavelengths) const {
    const auto hits = std::span(crossings.hits).first(crossings.count);
    std::ranges::sort(hits, {}, [](const RawHit& h) {
        return std::tuple(h.t, h.instance, h.primitive);
    });
    Spectrum transmittance{1.f};
    float here = 0, next = 0;
    for (const RawHit& hit : hits) {
        if (hit.t < next) continue;
        SurfaceHit surface;
        find_surface(ray, hit, surface);
        transmittance *= transmittance_through(medium, ray, here, hit.t, wavelengths);
        here = hit.t;
        next = here + surface.error / std::abs(dot(surface.ng, surface.wo));
        if (is_invisible(hit.instance)) {
            medium = medium_behind(medium, hit.instance, {}, false, surface.front);
            if (transmittance.is_black()) return 0.f;
            continue;
        }
        const MaterialAt now = material(surface);
        const Bsdf bsdf = shade(now, textures(), surface, wavelengths);
        std::visit(
            [&](const auto& kind) {
                const bool bent = kind.bounds_volume() && !crossings.volumes;
                transmittance *= bent ? Spectrum(0.f) : kind.straight_transmittance(surface.wo);
                medium = beyond(medium, hit.instance, kind.interior(), kind.bounds_volume(), surface.front);
            },
            bsdf);
        if (transmittance.is_black()) return 0.f;
    }
    const bool finite = distance < std::numeric_limits<float>::infinity();
    if (finite || medium.medium) transmittance *= transmittance_through(medium, ray, here, distance, wavelengths);
    return transmittance;
}

}  // namespace dg
