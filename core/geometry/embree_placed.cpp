// embree_placed.cpp -- bounds of placed meshes.
#include "geometry/embree_placed.h"

#include <limits>

namespace dg::embree {

WorldBounds world_bounds(const Mesh& mesh, const Affine3f& world_from_local) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    WorldBounds b{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, {}, 0};
    float largest = 0;
    for (const Vec3f& p : mesh.positions) {
        const Vec3f q = world_from_local.point(p);
        for (int k = 0; k < 3; ++k) {
            b.min[k] = std::min(b.min[k], q[k]);
            b.max[k] = std::max(b.max[k], q[k]);
            largest = std::max(largest, std::abs(q[k]));
        }
    }
    const float slack = 16 * 0x1p-24f * largest;
    const Vec3f around = reach_around(mesh, world_from_local);
    const Vec3f grow{slack + around.x, slack + around.y, slack + around.z};
    b.min = b.min - grow;
    b.max = b.max + grow;
    b.center = (b.min + b.max) * 0.5f;
    for (const Vec3f& p : mesh.positions) {
        const float r2 = length_squared(world_from_local.point(p) - b.center);
        b.radius_squared = std::max(b.radius_squared, r2);
    }
    const float radius = 1.0001f * std::sqrt(b.radius_squared) + 4 * slack + length(around);
    b.radius_squared = radius * radius;
    return b;
}

}  // namespace dg::embree
