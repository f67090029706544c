// polygon.h -- the opening of a bladed iris: a regular polygon whose edges may be bent.
#pragma once
#include "math/vec.h"

namespace dg {

/// Corners lie on the unit circle, the first at `rotation_rad` from +x,
/// counter-clockwise. An edge is a circular arc through its two corners; `curvature` says
/// how far its middle stands out: 0 straight, 1 the unit circle itself, -1 bent inward as
/// much (three blades: until the corners are cusps). Scale by sqrt(pi / area()) for equal
/// area with the unit disc. Sampling is uniform over the area, by inverting the area
/// swept along the edge.
class CurvedPolygon {
  public:
    /// Throws Error unless blades >= 3 and curvature is in [-1, 1].
    CurvedPolygon(int blades, double rotation_rad, double curvature);

    Vec2f sample(Vec2f u) const;
    /// 1 / area inside, 0 outside.
    float pdf(Vec2f p) const { return contains(p) ? float(1 / area_) : 0.f; }
    bool contains(Vec2f p) const;
    double area() const { return area_; }
    int blades() const { return blades_; }

  private:
    double edge(double y) const;  // distance of the edge from the centre line
    double swept_half(
        double y) const;  // area between the edge from 0 to y and the centre

    int blades_;
    double rotation_, half_angle_;
    double apothem_, half_edge_, bend_;  // bend: 1 / radius of the arc, signed
    double half_sector_, area_;
};

}  // namespace dg
