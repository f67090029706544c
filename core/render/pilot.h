// pilot.h -- chooses the number of light paths of a picture from a pilot of few camera samples and light paths
// (plan_choice.h).
//
// Two camera samples for each pixel of a coarse picture estimate the mean and variance of light that only the camera
// can find, and the number of rays per sample. One light path per 16 pixels estimates, from the densities of both
// techniques, the variance of the remaining light for any number of light paths, including lamps that no camera sample
// of the pilot has hit. The pilot takes about a sixth of the time of one sample of every pixel.
//
// Costs are counted in rays, with fixed prices for other work, instead of measured times. So the plan depends only on
// scene, camera and settings, and not on the number of threads or the range of samples. The plan is for the whole
// frame: a render of a crop scales it by the crop's share of the frame's pixels. The pilot's random numbers differ from
// the picture's, as sharing them would bias the picture.
#pragma once
#include "render/render.h"

namespace dg {

/// The plan for the whole frame; off if the scene has no emitter for light paths.
LightPlan pilot(const Scene& scene, const Camera& camera, const RenderSettings& settings);

}  // namespace dg
