// highlight_survey.h -- a coarse look around from the front of a lens, for light that other things send there:
// lamps in mirrors, the sun on chrome and water, bright walls. Found once for a picture, before its ghosts.
//
// Paths from all over the front and over the exposure look everywhere; bright spots are looked at again, more
// and more closely. Lamps too small to be come upon in mirrors are spread out at first (glints.h). What lights
// the front directly is left out.
#pragma once
#include <functional>

#include "camera/shutter.h"
#include "light/emitter_points.h"
#include "transport/path.h"

namespace dg {

/// A ray of the lens to a point or direction of the world, from a place [-1, 1)^2 of its front; world. Nothing
/// where no light enters.
using FrontRay = std::function<std::optional<Ray>(const EmitterPoint& to, Vec2f at, float time)>;

struct SurveyView {
    Vec3f anchor;        // m: middle of the front, at mid-exposure
    float radius;        // of the front
    FrontRay ray;
    const Shutter& shutter;
    PathSettings path;
    int threads;
};

struct Survey {
    Highlights highlights;
    std::uint64_t rays = 0;   // that it took
};

/// `lamps`: what may be seen in mirrors. The same for any number of threads. Empty if no path found anything.
Survey survey_highlights(const Scene& scene, const EmitterPoints& lamps, const SurveyView& view);

}  // namespace dg
