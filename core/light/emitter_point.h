// emitter_point.h -- where light of a flare path comes from.
#pragma once
#include <optional>

#include "light/emission.h"

namespace dg {

/// A point that shines, or a direction from which light comes; or a point through which light comes that
/// other things send on.
struct EmitterPoint {
    EmissionPoint point;     // pdf: as of EmissionPoint; of a delta light the choice alone
    bool at_infinity = false;
    bool delta = false;      // a light without size
    std::optional<float> reflected{};   // cd/m2 that a survey expects there: the point does not shine itself
};

}  // namespace dg
