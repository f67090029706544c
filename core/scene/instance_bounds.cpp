#include "scene/instance_bounds.h"

#include <array>

#include "motion/moving_bounds.h"
#include "scene/scene.h"

namespace dg {
namespace {

Hull corners_of(const Mesh& mesh) {
    Bounds own = Bounds::none();
    for (const Vec3f p : mesh.positions) own.hold(p);
    std::array<Vec3f, 8> corners;
    for (unsigned k = 0; k < 8; ++k)
        corners[k] = {k & 1 ? own.max.x : own.min.x, k & 2 ? own.max.y : own.min.y, k & 4 ? own.max.z : own.min.z};
    return Hull(corners);
}

}  // namespace

Bounds bounds_of_still(const Mesh& mesh, const Instance& instance) {
    Bounds all = Bounds::none();
    for (const Vec3f p : mesh.positions) all.hold(instance.world_from_local.point(p));
    const Vec3f around = reach_around(mesh, instance.world_from_local);
    return {all.min - around, all.max + around};
}

Bounds bounds_over_time(const Mesh& mesh, const Instance& instance) {
    if (!instance.motion) return bounds_of_still(mesh, instance);
    Bounds all = Bounds::none();
    if (mesh.positions.empty()) return all;
    for (const Box& box : moving_bounds(corners_of(mesh), *instance.motion).boxes)
        all.hold(to_float(box.min)), all.hold(to_float(box.max));
    return all;
}

}  // namespace dg
