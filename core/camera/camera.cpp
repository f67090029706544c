#include "camera/camera.h"

namespace dg {

void generate_rays(const Camera& camera, std::span<const CameraSample> samples,
                   std::span<CameraRay> rays) {
    std::visit([&](const auto& lens) { lens.generate(samples, rays); }, camera.lens);
}

Ray to_world(const Camera& camera, const Ray& ray) {
    const Affine3d pose = camera.world_from_camera.at(ray.time);
    Ray world = ray;
    world.origin = to_float(pose.point(to_double(ray.origin)));
    world.direction = to_float(pose.vector(to_double(ray.direction)));
    return world;
}

}  // namespace dg
