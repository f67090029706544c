#include "camera/camera.h"

namespace dg {

Ray to_world(const Camera& camera, const Ray& ray) {
    const Affine3d pose = camera.world_from_camera.at(ray.time);
    Ray world = ray;
    world.origin = to_float(pose.point(to_double(ray.origin)));
    world.direction = to_float(pose.vector(to_double(ray.direction)));
    return world;
}

}  // namespace dg
