// highlight_survey.h -- finds bright reflections in the scene as seen from the front of a lens: lamps in mirrors, the
// sun on chrome and water, bright walls. Runs once per picture, before its ghosts.
//
// Paths from random points of the front, at random times of the exposure, sample all directions; bright spots are
// sampled again with increasing resolution. Lamps that are too small to be hit in mirrors are enlarged at first
// (glints.h). Direct light on the front is excluded.
#pragma once
#include <functional>

#include "camera/shutter.h"
#include "light/emitter_points.h"
#include "transport/path.h"

namespace dg {

/// World ray from a point [-1, 1)^2 of the front to a world point or direction. Empty where no light enters the lens.
using FrontRay = std::function<std::optional<Ray>(const EmitterPoint& to, Vec2f at, float time)>;

struct SurveyView {
    Vec3f anchor;        // m: center of the front, at mid-exposure
    float radius;        // m: of the front
    FrontRay ray;
    const Shutter& shutter;
    PathSettings path;
    int threads;
};

struct Survey {
    Highlights highlights;
    std::uint64_t rays = 0;   // number of rays traced
};

/// `lamps`: sources that mirrors may show. The result does not depend on the number of threads. Empty if no path finds
/// light.
Survey survey_highlights(const Scene& scene, const EmitterPoints& lamps, const SurveyView& view);

}  // namespace dg
