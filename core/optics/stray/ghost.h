// ghost.h -- ways through a lens by two reflections, checked against the lens.
#pragma once
#include "optics/trace/trace.h"

namespace dg {

/// Light reflected at two surfaces, named in either order: at the one farther along
/// first. Error unless both exist, differ and have different media on both sides.
LensPath ghost_path(const Tracer& tracer, int one, int other, bool toward_film);

/// The path cut at its crossing of the stop number `crossing` (0: the first; -1: the
/// last).
LensPath path_to_stop(const Tracer& tracer, LensPath path, int crossing);

}  // namespace dg
