// curves.h -- round curves as arrays: tubes of changing radius, for hair, grass and cables.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/shared_array.h"
#include "math/vec.h"

namespace dg {

struct Mesh;

/// Curves of a mesh that has no triangles. Their control points are the positions of the mesh, curve
/// after curve: 3 n + 1 of n cubic Bezier segments, which share their ends, or n + 1 of n straight
/// ones. A cubic segment is swept by a disc across it, and closed by a flat disc where the curve
/// ends; a straight one is the hull of the balls at its ends. Colours and texture set 0 of the mesh
/// have one value per position or one per curve.
struct Curves {
    bool cubic = true;
    bool closed = false;              // each curve ends where it begins
    SharedArray<float> radii;         // m, one per position, at all times
    SharedArray<std::uint32_t> starts;  // first position of each segment
    SharedArray<std::uint32_t> ends;    // one past the last segment of each curve
    /// Unit vector across each segment where it begins, one after the other for each time step: the
    /// direction from which the way around the curve is counted. complete() makes them.
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

    /// Throws Error that names what is wrong with the curves of a mesh.
    void validate(const Mesh& mesh) const;
    /// Makes the references, which turn along each curve and over time as little as they can (Bishop
    /// 1975, There is more than one way to frame a curve).
    void complete(const Mesh& mesh);
};

/// One segment at one time.
struct CurveSegment {
    bool cubic = true;
    Vec3d points[4];
    double radii[4];
    Vec3d reference;  // across the segment where it begins, nearly

    Vec3d center(double u) const;
    double radius(double u) const;
    Vec3d derivative(double u) const;
    Vec3d tangent(double u) const;  // unit; also where the derivative is 0
    /// A unit vector across the curve at u, from which angles are counted.
    Vec3d zero_angle(double u) const;
};

CurveSegment segment_at(const Mesh& mesh, std::uint32_t segment, float time);

/// Weights of the control points of a segment, of which there are points_per_segment() + 1.
struct CurveWeights {
    double of[4];
};
CurveWeights weights_at(bool cubic, double u);

/// Place on the surface of a segment. `along` is 0 to 1 from one end to the other; from -1 to 0 and
/// from 1 to 2 it lies on the caps, with the middle of a cap at -1 and 2. `around` is the angle as a
/// share of a turn, 0 to 1.
struct CurvePlace {
    float along, around;
};

struct CurvePoint {
    Vec3d position;
    Vec3d normal;    // unit, outward
    Vec3d by_along;  // derivatives of the position by both numbers of the place
    Vec3d by_around;
    double radius;
};
CurvePoint point_on(const CurveSegment& segment, CurvePlace place);

/// The place that has a normal: `u` is where the centre line is met.
CurvePlace place_of(const CurveSegment& segment, double u, Vec3d normal);
/// The same on the flat cap at one end, of an offset from its middle.
CurvePlace place_on_cap(const CurveSegment& segment, bool at_end, Vec3d offset);

}  // namespace dg
