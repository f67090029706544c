// follow.cpp -- points of surfaces through time, for ground truth.
#include "scene/scene.h"

namespace dg {

Scene::Hit Scene::surface(const Ray& ray, const RawHit& raw) const {
    Hit hit;
    SurfaceHit& s = hit.surface;
    if (raw.instance != RawHit::kSphere) {
        find_surface(ray, raw, s);
        return hit;
    }
    hit.sphere_light = raw.primitive;
    s.wo = -ray.direction;
    s.t = raw.t;
    s.time = ray.time;
    s.position = ray.origin + ray.direction * raw.t;
    s.ng = s.ns = normalize(s.position - sphere(raw.primitive, ray.time).center);
    s.instance = RawHit::kSphere;
    s.primitive = raw.primitive;
    return hit;
}

std::optional<Vec3d> Scene::follow(const RawHit& hit, Vec3f normal, float time) const {
    if (hit.instance == RawHit::kSphere) {
        const Sphere s = sphere(hit.primitive, time);
        return to_double(s.center) + to_double(normal) * double(s.radius);
    }
    const InstanceRecord& record = records_[hit.instance];
    if (!record.is_shown(time)) return std::nullopt;
    return point_at(record, hit.primitive, hit.u, hit.v, time);
}

/// The sphere light of that index among the sphere lights.
Sphere Scene::sphere(std::uint32_t index, float) const {
    for (const Light& light : description_.lights)
        if (const auto* s = std::get_if<SphereLight>(&light); s && index-- == 0)
            return s->shape;
    return {};
}

}  // namespace dg
