// plate_view.h -- what a photograph of the set shows of a place, unless something of the set hides the place from the
// camera that took it.
#pragma once
#include <optional>

#include "transport/walk/path_state.h"

namespace dg {

/// Luminance (cd/m2) of the background in the direction of the path's ray. Settings have a plate.
std::optional<Rgb> plate_of_sky(PathState& path);

/// Luminance of a surface of the set.
std::optional<Rgb> plate_of_surface(PathState& path, const SurfaceHit& hit);

}  // namespace dg
