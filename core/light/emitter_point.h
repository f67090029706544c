// emitter_point.h -- the source point of a flare path.
#pragma once
#include <optional>

#include "light/emission.h"

namespace dg {

/// A point on an emitter, a direction toward an emitter, or a point that reflected light passes.
struct EmitterPoint {
    EmissionPoint point;     // for delta lights, pdf is the probability of the choice
    bool at_infinity = false;
    bool delta = false;      // a delta light
    std::optional<float> reflected{};   // cd/m2: reflected luminance expected by a survey; the point is no emitter
};

}  // namespace dg
