// lens_fit_make.h -- the steps of make_lens_fit().
#pragma once
#include "optics/expansion/fit_rays.h"

namespace dg {

/// First index, in the sequence of rays, of rays that are not used in fits.
inline constexpr int kFreshRays = 1 << 20;
/// Error estimates include clipped rays: they trace the exact lens with mounts widened by this
/// factor.
inline constexpr double kErrorWidened = 1.3;

/// Mounts that clip rays inside the iris and all other mounts, ordered by number of clipped rays.
std::vector<FitMount> limiting_mounts(const Tracer& tracer,
                                      const std::vector<FitSample>& samples);

/// Effort of a fit.
struct FitEffort {
    int terms = 0;       // per vector; 0: complete bases, reduced where the tolerance allows
    double focus = 1e9;  // mm, distance in focus
};

/// Least-squares fit over the samples of a segment; `domain` gives the range and the bend.
/// Direction, offset and transmittance use `clear` (a third of the samples, plus those with the
/// largest errors among the rest); iris and mounts use `wide` (with `met`).
FitSegment fit_segment(const LensFit& fit, const std::vector<FitSample>& clear,
                       const std::vector<FitSample>& wide, const FitSegment& domain,
                       const FitEffort& effort = {});
/// Root mean square error of the direction.
double direction_residual(const LensFit& fit, const FitSegment& segment,
                          const std::vector<FitSample>& samples);
FitInverse fit_inverse(const LensFit& fit, const std::vector<FitSample>& clear);

FitError measure_fit(const FitRays& rays, const LensFit& fit, int count);

}  // namespace dg
