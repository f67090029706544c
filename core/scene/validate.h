// validate.h -- validation of a scene description.
#pragma once
#include "scene/scene.h"

namespace dg {

/// Throws Error that names the invalid part: a mesh, texture or material, or an instance with an index out of range or
/// a transform that is not finite or singular.
void validate(const SceneDescription& description);

}  // namespace dg
