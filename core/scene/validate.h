// validate.h -- the checks of a scene description, before anything is built from it.
#pragma once
#include "scene/scene.h"

namespace dg {

/// Throws Error that names the part: meshes, textures and materials by their own checks;
/// instances with an index out of range, or a transform that is not finite or singular.
void validate(const SceneDescription& description);

}  // namespace dg
