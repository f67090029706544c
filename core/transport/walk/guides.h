// guides.h -- records the first hit of a path and the denoiser's guides (FirstHit).
#pragma once
#include "material/material.h"
#include "transport/walk/path_state.h"

namespace dg {

/// Records the first surface, and the first rough surface behind mirrors and smooth glass.
void note_surface(PathState& path, const Material& material, const SurfaceHit& hit, bool smooth);

/// Records scattering by a medium as albedo 1 without a normal.
void note_medium(PathState& path);

}  // namespace dg
