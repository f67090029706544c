#include "transport/walk/guides.h"

namespace dg {

void note_surface(PathState& path, const Material& material, const SurfaceHit& hit, bool smooth) {
    FirstHit& first = *path.first_hit;
    if (first.found && smooth) return;
    const Rgb color = albedo(material, path.scene.textures(), hit);
    if (!first.found) first = {true, path.scene.met(hit), hit.ns, color, hit.instance, {}, {}};
    if (smooth) return;
    const float share = path.walk.throughput.average();
    first.guide_albedo = first.guide_albedo + color * share;
    first.guide_normal = first.guide_normal + hit.ns * share;
    path.walk.guides_recorded = true;
}

void note_medium(PathState& path) {
    if (!path.first_hit || path.walk.guides_recorded) return;
    const float share = path.walk.throughput.average();
    path.first_hit->guide_albedo = path.first_hit->guide_albedo + Rgb{share, share, share};
    path.walk.guides_recorded = true;
}

}  // namespace dg
