// interior.h -- the solids and media around a ray that leaves a vertex of a camera path. Boundaries without a BSDF
// (Path::pass_boundary), light paths (LightWalk) and shadow rays (Scene::visibility) follow the same rules, which are in
// Scene::beyond and Scene::cross_nested.
#pragma once
#include "material/bsdf_kind.h"
#include "scene/scene.h"
#include "transport/walk/path_state.h"

namespace dg {

/// The solids and media around the origin of a camera ray.
inline Surroundings surroundings_at_camera(const Scene& scene, const PathSettings& settings, const Ray& ray,
                                           const Wavelengths& wavelengths) {
    if (!settings.solids_near.empty())
        if (const auto solids = scene.around(ray, settings.solids_near, wavelengths)) return *solids;
    return {scene.has_media() ? scene.medium_around(ray) : Interior{}, {}};
}

/// Sets the index outside the boundary of a ranked solid. False: a solid of a higher rank hides the boundary. Light paths
/// end in nested solids, so MIS with light paths ends here.
inline bool resolve_boundary(PathState& path, SurfaceHit& hit) {
    const Solids& solids = path.walk.media.around.solids;
    const bool visible = path.scene.resolve_boundary(solids, hit, path.wavelengths);
    if (!visible || hit.outside_ior != 1 || path.scene.in_other(solids, hit.instance))
        path.walk.light_mis.path_mis = nullptr;
    return visible;
}

/// Crosses a boundary that does not scatter: of a medium without a material, or the hidden boundary of a solid.
inline void cross_unscattered(const Scene& scene, Surroundings& around, const SurfaceHit& hit) {
    if (scene.is_invisible(hit.instance))
        around.interior = scene.beyond(around.interior, hit.instance, {}, false, hit.front);
    else scene.cross_boundary(around.solids, hit, hit.front);
}

/// Whether `wi` and hit.wo are on opposite sides of the surface.
inline bool is_transmitted(const SurfaceHit& hit, Vec3f wi) { return (dot(wi, hit.ng) > 0) != hit.front; }

/// Interior around the ray that leaves `hit` along `wi`. `here`: interior on the side from which the path arrived.
template <Scatters B>
Interior interior_after(const Scene& scene, const Interior& here, const SurfaceHit& hit, const B& bsdf, Vec3f wi) {
    if constexpr (PhaseKind<B>) return here;
    if (!is_transmitted(hit, wi)) return here;
    return scene.beyond(here, hit.instance, bsdf.interior(), bsdf.bounds_volume(), hit.front);
}

/// Updates the surroundings for the ray that leaves `hit` along `wi`. On entry they are on the side of hit.wo.
template <Scatters B>
void leave_along(const Scene& scene, Surroundings& around, const SurfaceHit& hit, const B& bsdf, Vec3f wi,
                 const Wavelengths& wavelengths) {
    if constexpr (PhaseKind<B>) return;
    if (scene.rank(hit.instance) == 0) around.interior = interior_after(scene, around.interior, hit, bsdf, wi);
    else if (is_transmitted(hit, wi)) scene.cross_nested(around, hit, hit.front, wavelengths);
}

/// Visibility of a light sample from a hit. `ray`: from ray_to_light().
template <Scatters B>
Spectrum visibility_of(const PathState& path, const SurfaceHit& hit, const B& bsdf, const LightSample& light,
                       const Ray& ray) {
    const Scene& scene = path.scene;
    if (scene.has_nested()) {
        Surroundings around = path.walk.media.around;
        leave_along(scene, around, hit, bsdf, light.wi, path.wavelengths);
        return scene.visibility_nested(ray, light.delta, around, path.wavelengths);
    }
    const Interior interior = interior_after(scene, path.walk.media.around.interior, hit, bsdf, light.wi);
    return scene.visibility(ray, light.delta, interior, path.wavelengths);
}

}  // namespace dg
