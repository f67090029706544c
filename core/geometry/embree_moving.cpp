#include "geometry/embree_moving.h"

#include "motion/moving_bounds.h"

namespace dg::embree {

MovingMesh::MovingMesh(RTCScene scene, std::uint32_t id, const Hull& hull,
                       const InstanceGeometry& instance)
    : scene(scene),
      id(id),
      motion_(instance.motion ? *instance.motion : to_double(instance.world_from_local)),
      shown_(instance.shown) {
    const MovingBounds bounds = moving_bounds(hull, motion_);
    float far = 0;
    for (const Box& b : bounds.boxes)
        for (const Vec3d corner : {b.min, b.max}) far = std::max(far, float(largest_coordinate(corner)));
    const float slack = 16 * 0x1p-24f * far;  // rounding of the ray, as for static instances
    const Vec3f grow{slack, slack, slack};
    for (const Box& b : bounds.boxes)
        boxes_.push_back({to_float(b.min) - grow, to_float(b.max) + grow});
    for (const dg::Ball& b : bounds.balls) {
        const float radius = 1.0001f * float(b.radius) + 4 * slack;
        balls_.push_back({to_float(b.center), radius * radius});
    }
}

Box MovingMesh::box() const {
    Box all{to_double(boxes_[0].min), to_double(boxes_[0].max)};
    for (const BoxAtStep& b : boxes_) {
        for (int k = 0; k < 3; ++k) {
            all.min[k] = std::min(all.min[k], double(b.min[k]));
            all.max[k] = std::max(all.max[k], double(b.max[k]));
        }
    }
    return all;
}

bool MovingMesh::near(const RTCRay& ray) const {
    if (shown_ && !shown_->at(ray.time)) return false;
    const std::size_t steps = balls_.size() - 1;
    if (steps == 0) return comes_near(ray, balls_[0].center, balls_[0].radius_squared);
    const float x = ray.time * float(steps);
    const std::size_t i = std::min(std::size_t(x), steps - 1);
    const Ball &a = balls_[i], &b = balls_[i + 1];
    const Vec3f center = a.center + (b.center - a.center) * (x - float(i));
    return comes_near(ray, center, a.radius_squared);
}

}  // namespace dg::embree
