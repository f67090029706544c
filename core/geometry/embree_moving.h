// embree_moving.h -- instances that move or are not always there, traced by the exact inverse of their
// transform at the time of each ray. Embree is told linear boxes only (see motion/moving_bounds.h).
#pragma once
#include <vector>

#include "geometry/embree_placed.h"
#include "geometry/intersector.h"
#include "motion/hull.h"

namespace dg::embree {

class MovingMesh {
  public:
    MovingMesh(RTCScene scene, std::uint32_t id, const Hull& hull,
               const InstanceGeometry& instance);

    RTCScene scene;    // of the mesh, in its own space
    std::uint32_t id;  // of the instance
    const TracedCurves* curves = nullptr;  // see PlacedMesh

    bool near(const RTCRay& ray) const;
    /// Where the transform has no inverse at the time of the ray, a ray that meets nothing.
    RTCRay to_local(const RTCRay& ray) const {
        const RTCRay local = transformed(ray, inverse(motion_.at(ray.time)));
        const bool good = is_traceable({local.org_x, local.org_y, local.org_z},
                                       {local.dir_x, local.dir_y, local.dir_z});
        return good ? local : nowhere(ray);
    }
    Box box() const;  // at all times
    unsigned steps() const { return unsigned(boxes_.size()); }
    void bounds(unsigned step, RTCBounds& out) const {
        set_bounds(out, boxes_[step].min, boxes_[step].max);
    }

  private:
    struct BoxAtStep {
        Vec3f min, max;
    };
    struct Ball {  // the radius holds until the next
        Vec3f center;
        float radius_squared;
    };
    Motion motion_;
    const Shown* shown_;
    std::vector<BoxAtStep> boxes_;
    std::vector<Ball> balls_;
};

}  // namespace dg::embree
