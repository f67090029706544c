// lens_map.h -- Taylor expansion of a lens or of one of its ghosts, by tracing a ray of power
// series through its surfaces.
#pragma once
#include "optics/expansion/ray_map.h"
#include "optics/trace/trace.h"

namespace dg {

/// x and y of the lens frame on all planes, in both directions. The map ends on the plane end_z. A
/// path to the iris ends with the point on the surface of the stop, in its frame, and the direction
/// before it.
struct LensWay {
    LensPath path;
    double start_z = 0, end_z = 0;  // mm, lens frame
    bool to_iris = false;           // the last step of the path is the stop's surface
    RayNumbers about{};             // base ray on the plane start_z
};

/// Expands the lens by tracing series; no closed forms per surface are needed (Hullin, Hanika and
/// Heidrich 2012, Polynomial Optics, CGF 31(4)). Ignores ripple (ripple.h). Throws LensError with
/// the surface if the base ray misses it or is totally reflected, or if a surface has no expansion
/// at the intersection. Clear apertures do not clip.
RayMap lens_map(const Tracer& tracer, const LensIndices& n, const LensWay& way,
                int degree);

}  // namespace dg
