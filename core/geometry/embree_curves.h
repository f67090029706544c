// embree_curves.h -- cubic curves by Embree's round ones, in units that suit it.
#pragma once
#include <vector>

#include "geometry/embree_device.h"
#include "geometry/mesh.h"
#include "geometry/ray.h"

namespace dg::embree {

/// Curves as Embree sees them, and the way from its hits to ours. Straight segments bring their hits
/// as they are (embree_rounds.h). Embree's search for the place along
/// a cubic segment ends at an error that is partly absolute (of the order of 1e-6): a hair of
/// 0.00005 m would be met within a few per cent of its radius. So Embree gets lengths in units of
/// about the radius: times a power of two, which rounds nothing.
class TracedCurves {
  public:
    explicit TracedCurves(const Mesh& mesh);

    bool cubic() const { return mesh_->curves.cubic; }
    /// Geometry 0 of the mesh's scene, of cubic segments.
    GeometryOwner segments(Device& device) const;
    /// Geometry 1: the flat ends of cubic segments; empty where nothing ends.
    GeometryOwner caps(Device& device);

    /// From the mesh's space to Embree's; distances along the ray stay.
    void scale(RTCRay& ray) const {
        const float by = cubic() ? scale_ : 1;
        ray.org_x *= by, ray.org_y *= by, ray.org_z *= by;
        ray.dir_x *= by, ray.dir_y *= by, ray.dir_z *= by;
    }
    /// Turns primID, u and v into segment and place; `ray` is Embree's, with tfar at the hit.
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
