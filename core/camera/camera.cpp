#include "camera/camera.h"

namespace dg {

void undo_film_shift(const Camera& camera, std::span<const CameraRay> rays, std::span<Reprojection> landings) {
    if (camera.setting.values.empty()) return;
    for (std::size_t i = 0; i < landings.size(); ++i)
        landings[i].film_mm = landings[i].film_mm - setting_at(camera, rays[i].ray.time).film_shift_mm;
}

Ray to_world(const Camera& camera, const Ray& ray) {
    const Affine3d pose = camera.world_from_camera.at(ray.time);
    Ray world = ray;
    world.origin = to_float(pose.point(to_double(ray.origin)));
    world.direction = to_float(pose.vector(to_double(ray.direction)));
    return world;
}

}  // namespace dg
