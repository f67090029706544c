// lens_fit_make.h -- the steps of make_lens_fit().
#pragma once
#include "optics/polynomial/fit_rays.h"

namespace dg {

/// Where in the sequence of rays those begin that the fit has not seen.
inline constexpr int kFreshRays = 1 << 20;
/// Rays that are stopped are compared as well: the exact lens, with its mounts widened by
/// this factor.
inline constexpr double kErrorWidened = 1.3;

/// The mounts that stop rays which iris and other mounts let through, the busiest first.
std::vector<FitMount> limiting_mounts(const Tracer& tracer,
                                      const std::vector<FitSample>& samples);

/// Least squares over the samples of one segment: `clear` for rays and light, `wide`
/// (with the mounts met) for iris and mounts. terms 0: the complete basis; else so many
/// for each vector.
FitSegment fit_segment(const LensFit& fit, const std::vector<FitSample>& clear,
                       const std::vector<FitSample>& wide, double u_low, double u_high,
                       int terms = 0);
/// Root of the mean squared error in direction over samples.
double direction_residual(const LensFit& fit, const FitSegment& segment,
                          const std::vector<FitSample>& samples);
FitInverse fit_inverse(const LensFit& fit, const std::vector<FitSample>& clear);

FitError measure_fit(const FitRays& rays, const LensFit& fit, int count);

}  // namespace dg
