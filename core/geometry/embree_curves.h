// embree_curves.h -- cubic curves as Embree's round curves, in scaled units.
#pragma once
#include <vector>

#include "geometry/embree_device.h"
#include "geometry/mesh.h"
#include "geometry/ray.h"

namespace dg::embree {

/// Curves in Embree's representation, and the conversion of its hits. Straight segments need none
/// (embree_rounds.h). Embree's root search along a cubic segment has a partly absolute error (of
/// the order of 1e-6): a hair of radius 0.00005 m would be hit within a few per cent of its radius.
/// Lengths are therefore scaled by a power of two, which is exact, so that radii are near 1.
class TracedCurves {
  public:
    explicit TracedCurves(const Mesh& mesh);

    bool cubic() const { return mesh_->curves.cubic; }
    /// Geometry 0 of the mesh's scene: cubic segments.
    GeometryOwner segments(Device& device) const;
    /// Geometry 1: flat caps of cubic segments; empty for closed curves.
    GeometryOwner caps(Device& device);

    /// Scales a ray from mesh space to Embree's units; distances along the ray are unchanged.
    void scale(RTCRay& ray) const {
        const float by = cubic() ? scale_ : 1;
        ray.org_x *= by, ray.org_y *= by, ray.org_z *= by;
        ray.dir_x *= by, ray.dir_y *= by, ray.dir_z *= by;
    }
    /// Converts primID, u and v to segment and surface position; `ray` is Embree's, with tfar at
    /// the hit.
    void set_place(const RTCRay& ray, RTCHit& hit) const;

  private:
    struct Cap {
        std::uint32_t segment;
        bool at_end;
    };
    void set_vertices(Device& device, RTCGeometry geometry) const;
    CurvePlace cap_place(const Cap& cap, const RTCRay& ray) const;

    const Mesh* mesh_;
    float scale_;
    std::vector<Cap> caps_;
};

}  // namespace dg::embree
