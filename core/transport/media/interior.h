// interior.h -- the volume or medium around a ray that leaves a vertex. Paths enter and leave volumes and media only
// here; rules for nested volumes belong here.
#pragma once
#include "material/bsdf_kind.h"
#include "scene/scene.h"

namespace dg {

/// `here`: interior on the side from which the path arrived. `wi`: direction of the outgoing ray.
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
