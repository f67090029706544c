// embree_moving.h -- instances that move or are visible only at times, traced by the exact inverse
// of their transform at the time of each ray. Embree only receives linear boxes (see
// motion/moving_bounds.h).
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

    RTCScene scene;    // of the mesh, in local space
    std::uint32_t id;  // of the instance
    const TracedCurves* curves = nullptr;  // see PlacedMesh

    bool near(const RTCRay& ray) const;
    /// Returns an untraceable ray if the transform is singular at the time of the ray.
    RTCRay to_local(const RTCRay& ray) const {
        const Affine3d now = motion_.at(ray.time);
        if (is_invertible(now)) return transformed(ray, inverse(now));
        RTCRay nowhere = ray;
        nowhere.tnear = std::numeric_limits<float>::quiet_NaN();
        return nowhere;
    }
    Box box() const;  // over all times
    unsigned steps() const { return unsigned(boxes_.size()); }
    void bounds(unsigned step, RTCBounds& out) const {
        set_bounds(out, boxes_[step].min, boxes_[step].max);
    }

  private:
    struct BoxAtStep {
        Vec3f min, max;
    };
    struct Ball {  // the radius holds until the next step
        Vec3f center;
        float radius_squared;
    };
    Motion motion_;
    const Shown* shown_;
    std::vector<BoxAtStep> boxes_;
    std::vector<Ball> balls_;
};

}  // namespace dg::embree
