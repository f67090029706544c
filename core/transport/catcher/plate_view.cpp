#include "transport/catcher/plate_view.h"

#include "transport/catcher/plate_light.h"

namespace dg {
namespace {

/// Whether no catcher occludes the ray.
bool is_clear(PathState& path, Ray ray) {
    ray.without_objects = true;
    ++path.rays;
    return !(path.scene.visibility(ray, false, {}, path.wavelengths).max() < 1);
}

}  // namespace

std::optional<Rgb> plate_of_sky(PathState& path) {
    const PlateLight& plate = *path.settings.plate;
    const Vec3f direction = path.walk.ray.direction;
    const float time = path.walk.ray.time;
    const auto shown = plate.at(direction, 0, time);
    if (!shown || !is_clear(path, {.origin = plate.eye(time), .direction = direction, .time = time})) return {};
    return shown;
}

std::optional<Rgb> plate_of_surface(PathState& path, const SurfaceHit& hit) {
    const PlateLight& plate = *path.settings.plate;
    const auto shown = plate.at(hit.position, 1, hit.time);
    if (!shown) return {};
    const Vec3f to_eye = plate.eye(hit.time) - hit.position;
    const float distance = length(to_eye);
    if (!is_clear(path, ray_to(hit, to_eye * (1 / distance), distance, hit.time))) return {};
    return shown;
}

}  // namespace dg
