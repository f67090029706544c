// interior.h -- the volume or medium around a ray that leaves a vertex of a camera path. Scene::beyond has the rule for
// each boundary. It is also called for boundaries without a material (Path::pass_boundary), for light paths
// (LightWalk), and for shadow rays (Scene::visibility).
#pragma once
#include "material/bsdf_kind.h"
#include "scene/scene.h"
#include "transport/walk/path_settings.h"

namespace dg {

/// The solid or medium around the origin of a camera ray.
inline Interior interior_at_camera(const Scene& scene, const PathSettings& settings, const Ray& ray,
                                   const Wavelengths& wavelengths) {
    if (!settings.solids_near.empty())
        if (const auto solid = scene.around(ray, settings.solids_near, wavelengths)) return *solid;
    return scene.has_media() ? scene.medium_around(ray) : Interior{};
}

/// Interior around the ray that leaves `hit` along `wi`. `here`: interior on the side from which the path arrived.
template <Scatters B>
Interior interior_after(const Scene& scene, const Interior& here, const SurfaceHit& hit, const B& bsdf,
                        Vec3f wi) {
    if constexpr (PhaseKind<B>) return here;
    const float side = dot(wi, hit.ng);
    const bool transmitted = (side > 0) != hit.front;
    if (!transmitted) return here;
    return scene.beyond(here, hit.instance, bsdf.interior(), bsdf.bounds_volume(), side < 0);
}

}  // namespace dg
