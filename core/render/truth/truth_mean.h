// truth_mean.h -- ground truth as means over the lens and the pixel's area at the time of the pixel, weighted by the
// transmittance of the lens.
//
// Each pixel has a fixed set of rays, so results are bit-identical. Means are over rays that hit a surface; the
// coverage is their share of the pixel's light. So vignetting shifts the mean but does not scale it.
#pragma once
#include "render/truth/truth.h"

namespace dg {

struct MeanTruth : TruthPlanes {
    explicit MeanTruth(const FilmLayout& region);

    /// Share of the pixel's light from rays that hit a surface. Each ID is the ID with the largest share; normals are
    /// normalized means.
    std::vector<float> coverage;
};

/// `rays`: number of rays per pixel. Exact lenses use the design wavelength. Uses only sensor, shutter and threads of
/// the settings.
MeanTruth see_mean(const TruthFrame& frame, const FilmLayout& region,
                   const RenderSettings& settings, int rays);

/// Mean motion (px) of the hits of the same rays from frame `now` to frame `then`, each measured between the film
/// points of its chief rays. Means over surface hits, or over the sky for pixels without surface hits. Hits without a
/// film point in `then` are skipped; NaN if none is left.
std::vector<Vec2d> mean_motion(const TruthFrame& now, const RenderSettings& now_settings,
                               const TruthFrame& then, const RenderSettings& then_settings,
                               const FilmLayout& region, int rays);

}  // namespace dg
