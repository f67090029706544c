// lens_map.h -- the Taylor expansion of a lens, or of a ghost in it, by tracing one ray
// of power series through its surfaces.
#pragma once
#include "optics/expansion/ray_map.h"
#include "optics/trace/trace.h"

namespace dg {

/// x and y are the lens frame's, on all planes and both ways. The end is the plane end_z,
/// or for a path that ends at the iris the point where the iris lies (in the frame of its
/// surface) and the direction before that.
struct LensWay {
    LensPath path;
    double start_z = 0, end_z = 0;  // mm, lens frame
    bool to_iris = false;           // the last step of the path is the stop's surface
    RayNumbers about{};             // the base ray, on the plane start_z
};

/// Source: Hullin, Hanika and Heidrich 2012, Polynomial Optics, CGF 31(4), with series in
/// place of closed forms. Grooves (ripple.h) are left out. LensError, naming the surface,
/// if the base ray is stopped by other than an aperture, or a surface has no expansion
/// where the ray meets it.
RayMap lens_map(const Tracer& tracer, const LensIndices& n, const LensWay& way,
                int degree);

}  // namespace dg
