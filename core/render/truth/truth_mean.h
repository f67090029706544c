// truth_mean.h -- ground truth as means over the rays that expose each pixel at its own moment:
// over the lens and the pixel's area, weighted by what the lens lets through.
//
// The rays are a fixed set of each pixel, so the same frame has the same bits. Means are over
// rays that meet a surface; which share they are of the light is the coverage. So vignetting
// moves a mean, and darkens nothing.
#pragma once
#include "render/truth/truth.h"

namespace dg {

struct MeanTruth : TruthPlanes {
    explicit MeanTruth(const FilmLayout& region);

    /// Share of the pixel's light whose rays meet a surface. Ids are those with the largest
    /// share; normals are the mean direction, of length 1.
    std::vector<float> coverage;
};

/// `rays` of each pixel; those of exact lenses are of the design wavelength. Of the settings
/// sensor, shutter and threads count.
MeanTruth see_mean(const TruthFrame& frame, const FilmLayout& region,
                   const RenderSettings& settings, int rays);

/// How far (px) what the same rays meet moves until another frame: from where its chief ray
/// has it now to where it has it then. Means over surfaces, or over the sky where none is met;
/// what has no place there is left out, NaN where nothing is left.
std::vector<Vec2d> mean_motion(const TruthFrame& now, const RenderSettings& now_settings,
                               const TruthFrame& then, const RenderSettings& then_settings,
                               const FilmLayout& region, int rays);

}  // namespace dg
