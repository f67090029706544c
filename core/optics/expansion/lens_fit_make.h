// lens_fit_make.h -- the steps of make_lens_fit().
#pragma once
#include "optics/expansion/fit_rays.h"

namespace dg {

/// Where in the sequence of rays those begin that the fit has not seen.
inline constexpr int kFreshRays = 1 << 20;
/// Rays that are stopped are compared as well: the exact lens, with its mounts widened by
/// this factor.
inline constexpr double kErrorWidened = 1.3;

/// The mounts that stop rays which iris and other mounts let through, the busiest first.
std::vector<FitMount> limiting_mounts(const Tracer& tracer,
                                      const std::vector<FitSample>& samples);

/// How far a fit goes.
struct FitEffort {
    int terms = 0;       // for each vector; 0: the complete basis where it is worth it
    double focus = 1e9;  // mm, the distance at which points should be sharp
};

/// Least squares over the samples of one segment, of which `domain` gives range and bend:
/// `clear` for direction, offset and light (a third, and of the rest what it misses
/// most), `wide` (with the mounts met) for iris and mounts.
FitSegment fit_segment(const LensFit& fit, const std::vector<FitSample>& clear,
                       const std::vector<FitSample>& wide, const FitSegment& domain,
                       const FitEffort& effort = {});
/// Root of the mean squared error in direction over samples.
double direction_residual(const LensFit& fit, const FitSegment& segment,
                          const std::vector<FitSample>& samples);
FitInverse fit_inverse(const LensFit& fit, const std::vector<FitSample>& clear);

FitError measure_fit(const FitRays& rays, const LensFit& fit, int count);

}  // namespace dg
