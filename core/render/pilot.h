// pilot.h -- how many light paths a picture gets: a few camera samples and light paths are drawn first, and
// tell what the best plan is (plan_choice.h).
//
// Camera samples, two for each of a coarser picture's pixels, tell mean and variance of what only they can
// find, and how many rays a sample takes. Light paths, as many as a 16th of the pixels, tell by the densities
// of both techniques how the rest would do with any number of them; a lamp that no camera sample of the
// pilot has met is not missed. Together they take about as long as a sixth of one sample of every pixel.
//
// No clock is asked: costs are counted in rays, with fixed prices for what else a path does. So the plan is a
// function of scene, camera and settings alone: of no number of threads and no range of samples. It is one for
// the whole frame, whatever is drawn of it: a session that draws a crop takes the share that the crop has of
// the frame's pixels. The pilot's random numbers are not the picture's, which would bias it.
#pragma once
#include "render/render.h"

namespace dg {

/// The plan for the whole frame; off where nothing shines that a light path could start from.
LightPlan pilot(const Scene& scene, const Camera& camera, const RenderSettings& settings);

}  // namespace dg
