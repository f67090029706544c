// ghost.h -- ghost paths of two reflections, validated against the lens.
#pragma once
#include "optics/trace/trace.h"

namespace dg {

/// Path of the ghost between two surfaces, given in either order; light first hits the surface
/// farther along. Throws Error unless both exist, differ, and have different media on their two
/// sides.
LensPath ghost_path(const Tracer& tracer, int one, int other, bool toward_film);

/// Path up to its crossing number `crossing` of the stop (0: the first; -1: the last).
LensPath path_to_stop(const Tracer& tracer, LensPath path, int crossing);

}  // namespace dg
