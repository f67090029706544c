// interior.h -- what fills the space of a ray that leaves a vertex: the one place where a path enters or leaves volumes
// and media. Rules of nested volumes belong here.
#pragma once
#include "material/bsdf_kind.h"
#include "scene/scene.h"

namespace dg {

/// `here` fills the space from which the path came, `wi` is where the ray goes.
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
