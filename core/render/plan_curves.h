// plan_curves.h -- estimated noise of a picture as a function of the number of light paths, with jackknife estimates.
// The formulas are in plan_choice.h.
#pragma once
#include <array>

#include "render/plan_choice.h"

namespace dg {

inline constexpr int kCandidates = 34;   // 0, then powers of sqrt(2)
inline constexpr int kGroups = 8;        // jackknife groups of the pilot's light paths
inline constexpr int kAll = kGroups;     // index of the estimate from all groups

/// Number of light paths per sample of a candidate.
double paths_of(int candidate);

/// Sum over pixels and channels of V(m) / (mean^2 + 0.01), for every candidate.
using Curve = std::array<double, kCandidates>;
/// Curves without each group of paths, and with all groups.
using NoiseCurves = std::array<Curve, kGroups + 1>;

/// Weights 1 / (mean^2 + 0.01) of the blocks, for the mean including direct arrivals. Means of few samples are averaged
/// with the neighbours: else a rare bright sample would raise the mean that it is compared with.
std::vector<Vec3f> weights_of(const PilotPicture& picture, const PilotArrivals& straight);

/// The curve's value for light that only the camera finds.
double rest_of(const PilotPicture& picture, std::span<const Vec3f> weights);

/// The arrivals without the brightest that a picture of 64 samples would seldom contain: fireflies that do not occur
/// need no light paths.
std::vector<PilotArrival> seen(const PilotArrivals& arrivals, std::span<const Vec3f> weights);

/// Noise of the arrivals for each number of light paths. `pixels`: per block.
NoiseCurves curves_of(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double pixels);

}  // namespace dg
