// changes.h -- what changes of a scene while the shutter is open, cut to the interval that is exposed:
// the wall between seconds and fractions of it.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "light/light_keys.h"
#include "material/material_keys.h"

namespace dg {

struct SceneDescription;

/// By material, null where it stays as it is; empty: they all do.
using MaterialChanges = std::vector<std::unique_ptr<MaterialChange>>;

/// Changes over time; those cut to a single key become plain again. In the description materials, lights and
/// environment are left as they are when the shutter opens, the environment with its poses; the keys are gone.
struct Changes {
    MaterialChanges materials;
    std::map<std::uint32_t, Keyed<Light>> lights;
};
Changes take_changes(SceneDescription& description);

}  // namespace dg
