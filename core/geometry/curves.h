// curves.h -- round curves as arrays: tubes of varying radius, for hair, grass and cables.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/shared_array.h"
#include "math/vec.h"

namespace dg {

struct Mesh;

/// Curves of a mesh without triangles. Control points are the positions of the mesh, curve by
/// curve: 3 n + 1 for n cubic Bezier segments, which share end points, or n + 1 for n straight
/// segments. A cubic segment is the sweep of a perpendicular disc, closed by flat discs at the ends
/// of the curve; a straight segment is the convex hull of the balls at its ends. Colours and
/// texture set 0 of the mesh have a value per position or per curve.
struct Curves {
    bool cubic = true;
    bool closed = false;              // each curve ends where it begins
    SharedArray<float> radii;         // m, per position, constant over time
    SharedArray<std::uint32_t> starts;  // first position of each segment
    SharedArray<std::uint32_t> ends;    // end (exclusive) of each curve's segments
    /// Unit vector perpendicular to each segment at its start, for each time step: the zero
    /// direction of angles around the curve. Filled by complete().
    SharedArray<Vec3f> references;

    bool empty() const { return starts.empty(); }
    std::uint32_t points_per_segment() const { return cubic ? 3 : 1; }
    std::uint32_t curve_of(std::uint32_t segment) const {
        return starts[segment] - segment * points_per_segment();
    }
    std::uint32_t first_segment(std::uint32_t curve) const { return curve == 0 ? 0 : ends[curve - 1]; }
    bool begins_curve(std::uint32_t segment) const {
        return segment == first_segment(curve_of(segment));
    }
    bool ends_curve(std::uint32_t segment) const { return segment + 1 == ends[curve_of(segment)]; }
    float largest_radius() const;

    /// Throws Error that describes the fault in the curves of a mesh.
    void validate(const Mesh& mesh) const;
    /// Computes the references as rotation-minimizing frames along each curve and over time (Bishop
    /// 1975, There is more than one way to frame a curve).
    void complete(const Mesh& mesh);
};

/// A segment at a point in time.
struct CurveSegment {
    bool cubic = true;
    Vec3d points[4];
    double radii[4];
    Vec3d reference;  // approximately perpendicular to the segment at its start

    Vec3d center(double u) const;
    double radius(double u) const;
    Vec3d derivative(double u) const;
    Vec3d tangent(double u) const;  // unit, defined even where the derivative is 0
    /// Unit vector perpendicular to the curve at u, the zero direction of angles.
    Vec3d zero_angle(double u) const;
};

CurveSegment segment_at(const Mesh& mesh, std::uint32_t segment, float time);

/// Weights of the points_per_segment() + 1 control points of a segment.
struct CurveWeights {
    double of[4];
};
CurveWeights weights_at(bool cubic, double u);

/// Position on the surface of a segment. `along` is 0 to 1 from end to end; -1 to 0 and 1 to 2 are
/// the caps, with their centres at -1 and 2. `around` is the angle as a fraction of a turn, 0 to 1.
struct CurvePlace {
    float along, around;
};

struct CurvePoint {
    Vec3d position;
    Vec3d normal;    // unit, outward
    Vec3d by_along;  // derivatives of the position by along and around
    Vec3d by_around;
    double radius;
};
CurvePoint point_on(const CurveSegment& segment, CurvePlace place);

/// Surface position with the given normal, at centre line parameter `u`.
CurvePlace place_of(const CurveSegment& segment, double u, Vec3d normal);
/// Surface position on the flat cap at an end, for an offset from its centre.
CurvePlace place_on_cap(const CurveSegment& segment, bool at_end, Vec3d offset);

}  // namespace dg
