// changes.h -- animated materials and lights of a scene, clipped to the exposed interval and converted from seconds to
// fractions of it.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "light/light_keys.h"
#include "material/material_keys.h"

namespace dg {

struct SceneDescription;

/// Animation of each material, null for static materials; empty if all are static.
using MaterialChanges = std::vector<std::unique_ptr<MaterialChange>>;

/// Extracts animation from the description. Keys clipped to a single key become static. In the description, materials,
/// lights and environment get their values at the opening of the shutter, the environment with its poses; keys are
/// removed.
struct Changes {
    MaterialChanges materials;
    std::map<std::uint32_t, Keyed<Light>> lights;
};
Changes take_changes(SceneDescription& description);

}  // namespace dg
