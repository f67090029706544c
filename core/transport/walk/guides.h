// guides.h -- the first hit of a path, and the guides that a denoiser gets from it (FirstHit).
#pragma once
#include "material/material.h"
#include "transport/walk/path_state.h"

namespace dg {

/// Notes the first surface, and the first that is not smooth behind mirrors and glass.
void note_surface(PathState& path, const Material& material, const SurfaceHit& hit, bool smooth);

/// Notes where a medium scatters the path: white, without a normal.
void note_medium(PathState& path);

}  // namespace dg
