// visibility.cpp -- transmittance of shadow rays through clear surfaces.
#include <algorithm>
#include <tuple>
#include <type_traits>

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

/// Where solids overlap, a ray has Surroundings; elsewhere an Interior suffices.
template <class Around>
constexpr bool kNested = std::is_same_v<Around, Surroundings>;

const Interior& interior_of(const Interior& around) { return around; }
Interior& interior_of(Interior& around) { return around; }
const Interior& interior_of(const Surroundings& around) { return around.interior; }
Interior& interior_of(Surroundings& around) { return around.interior; }

}  // namespace

Spectrum Scene::visibility(const Ray& ray, bool delta, const Interior& medium, const Wavelengths& wavelengths) const {
    return has_nested() ? transmittance_to_light(ray, delta, Surroundings{medium, {}}, wavelengths)
                       : transmittance_to_light(ray, delta, medium, wavelengths);
}

Spectrum Scene::visibility_nested(const Ray& ray, bool delta, const Surroundings& here,
                                  const Wavelengths& wavelengths) const {
    return transmittance_to_light(ray, delta, here, wavelengths);
}

Spectrum Scene::visibility_along(const Ray& ray, const Wavelengths& wavelengths) const {
    const bool looks = has_media_ && ray.t_max > ray.t_min;
    return visibility_from({looks ? medium_around(ray) : Interior{}, {}}, ray, false, wavelengths);
}

Spectrum Scene::visibility_from(const Surroundings& here, const Ray& ray, bool delta,
                                const Wavelengths& wavelengths) const {
    if (ray.t_max < 0) return 0.f;
    if (!(ray.t_max > ray.t_min)) return 1.f;
    return has_nested() ? transmission(ray, ray.t_max, delta, here, wavelengths)
                        : transmission(ray, ray.t_max, delta, here.interior, wavelengths);
}

template <class Around>
Spectrum Scene::transmittance_to_light(Ray ray, bool delta, const Around& here, const Wavelengths& wavelengths) const {
    const float distance = ray.t_max;
    stop_before(ray, distance);
    if (ray.t_max <= 0) return 1.f;
    return transmission(ray, distance, delta, here, wavelengths);
}

template <class Around>
Spectrum Scene::transmission(const Ray& ray, float distance, bool delta, const Around& here,
                             const Wavelengths& wavelengths) const {
    const Interior& interior = interior_of(here);
    if (!has_clear_ && !interior.present && !interior.medium) return intersector_->occluded(ray) ? 0.f : 1.f;
    Crossings crossings(delta || kNested<Around>);
    if (intersector_->occluded(ray, &crossings)) return 0.f;
    return through_crossings(ray, crossings, delta, here, distance, wavelengths);
}

/// Processes crossings in the order in which a path would hit them. Crossings closer than the offset of spawn_ray are
/// duplicates of the same surface.
template <class Around>
Spectrum Scene::through_crossings(const Ray& ray, Crossings& crossings, bool delta, Around around, float distance,
                                  const Wavelengths& wavelengths) const {
    Interior& interior = interior_of(around);
    const auto hits = std::span(crossings.hits).first(crossings.count);
    std::ranges::sort(hits, {}, [](const RawHit& h) {
        return std::tuple(h.t, h.instance, h.primitive);
    });
    Spectrum transmittance{1.f};
    float begin = 0, next = 0;   // of the segment, and the least distance of the next hit
    for (const RawHit& hit : hits) {
        if (hit.t < next) continue;
        SurfaceHit surface;
        find_surface(ray, hit, surface);
        transmittance *= transmittance_through(interior, ray, begin, hit.t, wavelengths);
        begin = hit.t;
        next = begin + surface.error / std::abs(dot(surface.ng, surface.wo));
        if (is_invisible(hit.instance)) {
            interior = medium_behind(interior, hit.instance, {}, false, surface.front);
            if (transmittance.is_black()) return 0.f;
            continue;
        }
        if constexpr (kNested<Around>) {
            if (rank(hit.instance) > 0 && !resolve_boundary(around.solids, surface, wavelengths)) {
                cross_boundary(around.solids, surface, surface.front);
                if (transmittance.is_black()) return 0.f;
                continue;
            }
        }
        const MaterialAt now = material(surface);
        const Bsdf bsdf = shade(now, textures(), surface, wavelengths);
        std::visit(
            [&](const auto& kind) {
                const bool bent = kind.bounds_volume() && !delta;
                transmittance *= bent ? Spectrum(0.f) : kind.straight_transmittance(surface.wo);
                interior = beyond(interior, hit.instance, kind.interior(), kind.bounds_volume(), surface.front);
            },
            bsdf);
        if constexpr (kNested<Around>)
            if (rank(hit.instance) > 0) cross_nested(around, surface, surface.front, wavelengths);
        if (transmittance.is_black()) return 0.f;
    }
    const bool finite = distance < std::numeric_limits<float>::infinity();
    if (finite || interior.medium) transmittance *= transmittance_through(interior, ray, begin, distance, wavelengths);
    return transmittance;
}

}  // namespace dg
