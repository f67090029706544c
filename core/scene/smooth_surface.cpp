#include "scene/smooth_surface.h"

#include "scene/scene.h"

namespace dg {
namespace {

constexpr double kShare = 0.5;   // of the lift by Hanika, twice too high over a quadratic surface

}  // namespace

/// Computed in the mesh's space: affine maps keep the construction.
Vec3f lift_to_smooth(const InstanceRecord& r, const Placement& place, const SurfaceHit& hit) {
    const auto& t = r.triangles[hit.primitive];
    const Vec3d corners[3] = {r.position(place, t[0]), r.position(place, t[1]), r.position(place, t[2])};
    const double u = hit.barycentric[0], v = hit.barycentric[1];
    const double shares[3] = {1 - u - v, u, v};
    const Vec3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const Vec3d point = corners[0] + e1 * u + e2 * v;
    Vec3d normals[3], mean{};
    for (int i = 0; i < 3; ++i) {
        normals[i] = to_double(r.normal(place, t[i]));
        mean += normals[i] * shares[i];
    }
    const double side = (dot(cross(e1, e2), mean) < 0) == hit.front ? -1 : 1;
    Vec3d lift{};
    for (int i = 0; i < 3; ++i) {
        const double height = side * dot(corners[i] - point, normals[i]), l2 = dot(normals[i], normals[i]);
        if (height > 0 && l2 > 1e-30) lift += normals[i] * (side * shares[i] * height / l2);
    }
    return to_float(place.world_from_local.vector(lift * kShare));
}

/// The hit stays in place where another surface is in between, as light would leak past that surface.
void Scene::lift(SurfaceHit& hit) const {
    const InstanceRecord& record = records_[hit.instance];
    const Vec3f lift = record.changes() ? lift_to_smooth(record, record.where(hit.time), hit)
                                        : lift_to_smooth(record, record.still, hit);
    const float height = length(lift);
    if (height > hit.error && (dot(lift, hit.ng) > 0) == hit.front) {
        Ray segment = spawn_ray(hit, lift / height, hit.time);
        segment.t_max = height;
        if (!intersector_->occluded(segment)) hit.position += lift;
    }
    use_smooth_normal(hit);
}

Vec3f Scene::met(const SurfaceHit& hit) const {
    if (!hit.smooth) return hit.position;
    const auto [u, v] = hit.barycentric;
    return to_float(point_at(records_[hit.instance], hit.primitive, u, v, hit.time));
}

}  // namespace dg
