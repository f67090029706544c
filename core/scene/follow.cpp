// follow.cpp -- follows surface points over time, for ground truth.
#include "scene/scene.h"

namespace dg {

Scene::Hit Scene::surface(const Ray& ray, const RawHit& raw) const {
    Hit hit;
    if (raw.instance != RawHit::kSphere) {
        find_surface(ray, raw, hit.surface);
        return hit;
    }
    find_sphere(ray, raw, hit);
    SurfaceHit& s = hit.surface;
    s.ng = s.ns =
        normalize(s.position - lights_.sphere_at(raw.primitive, ray.time).shape.center);
    return hit;
}

std::optional<Vec3d> Scene::follow(const RawHit& hit, Vec3f normal, float time) const {
    if (hit.instance == RawHit::kSphere) {
        const Sphere s = lights_.sphere_at(hit.primitive, time).shape;
        return to_double(s.center) + to_double(normal) * double(s.radius);
    }
    const InstanceRecord& record = records_[hit.instance];
    if (!record.is_shown(time)) return std::nullopt;
    return point_at(record, hit.primitive, hit.u, hit.v, time);
}

Vec3f Scene::sky_from_world(Vec3f direction, float time) const {
    const auto& sky = lights_.environment();
    return sky ? sky->to_picture(direction, time) : direction;
}

Vec3f Scene::world_from_sky(Vec3f direction, float time) const {
    const auto& sky = lights_.environment();
    return sky ? sky->to_world(direction, time) : direction;
}

}  // namespace dg
