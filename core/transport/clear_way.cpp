#include "transport/clear_way.h"

#include "transport/media/interior.h"

namespace dg {
namespace {

constexpr int kMostSurfaces = 64;   // along a ray, with hidden ones
constexpr int kTrials = 8;          // of a BSDF's lobes

/// Direction of the light behind a surface that passes at least half of it without scattering.
template <Scatters B>
std::optional<Vec3f> direction_behind(const B& bsdf, Vec3f wo) {
    std::optional<Vec3f> onward;
    int passed = 0;
    for (int i = 0; i < kTrials; ++i) {
        const auto s = bsdf.sample(seen_from(bsdf, wo), (float(i) + 0.5f) / kTrials, {0.5f, 0.5f});
        if (!s || !s->specular || !s->transmitted || s->weight.is_black()) continue;
        onward = s->wi;
        ++passed;
    }
    if (2 * passed < kTrials) return std::nullopt;
    return onward;
}

}  // namespace

std::vector<WayPoint> clear_way(const Scene& scene, Ray ray) {
    const Wavelengths wavelengths = Wavelengths::sample(0.5f);
    const Vec3d origin = to_double(ray.origin);
    const auto near = scene.solids_near({origin, origin});
    Surroundings around = scene.around(ray, near, wavelengths).value_or(Surroundings{});
    std::vector<WayPoint> way;
    for (int i = 0; i < kMostSurfaces && is_traceable(ray); ++i) {
        auto found = scene.intersect(ray);
        if (!found) break;
        SurfaceHit& hit = found->surface;
        if (found->sphere_light >= 0) {
            way.push_back({hit.position, Interior::kWorld, std::nullopt});
            break;
        }
        const bool hidden = scene.rank(hit.instance) > 0 && !scene.resolve_boundary(around.solids, hit, wavelengths);
        if (hidden || scene.is_invisible(hit.instance)) {
            cross_unscattered(scene, around, hit);
            ray = spawn_ray(hit, ray.direction, ray.time);
            continue;
        }
        const MaterialAt material = scene.material(hit);
        const Bsdf bsdf = scene.shade_smooth(material, hit, wavelengths);
        const auto onward = std::visit(
            [&](const auto& kind) {
                const auto wi = direction_behind(kind, hit.wo);
                if (wi) leave_along(scene, around, hit, kind, *wi, wavelengths);
                return wi;
            },
            bsdf);
        way.push_back({hit.position, hit.instance, onward});
        if (!onward) break;
        ray = spawn_ray(hit, *onward, ray.time);
    }
    return way;
}

}  // namespace dg
