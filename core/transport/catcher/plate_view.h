// plate_view.h -- luminance of a place in a plate (plate_light.h). Empty if catchers occlude the place from the camera
// of the photograph.
#pragma once
#include <optional>

#include "transport/walk/path_state.h"

namespace dg {

/// Luminance (cd/m2) of the background in the direction of the path's ray. The settings must have a plate.
std::optional<Rgb> plate_of_sky(PathState& path);

/// Luminance (cd/m2) of a catcher.
std::optional<Rgb> plate_of_surface(PathState& path, const SurfaceHit& hit);

}  // namespace dg
