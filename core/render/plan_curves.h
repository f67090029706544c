// plan_curves.h -- how noisy a picture would be with so many light paths, for many numbers of them; and how sure
// that is. The formulas are in plan_choice.h.
#pragma once
#include <array>

#include "render/plan_choice.h"

namespace dg {

inline constexpr int kCandidates = 34;   // 0, then powers of sqrt(2)
inline constexpr int kGroups = 8;        // of the pilot's light paths
inline constexpr int kAll = kGroups;     // the estimate that leaves none of them out

/// Number of light paths.
double paths_of(int candidate);

/// Sum over pixels and channels of V(m) / (mean^2 + 0.01), for every candidate.
using Curve = std::array<double, kCandidates>;
/// Without each group of paths, and with all.
using NoiseCurves = std::array<Curve, kGroups + 1>;

/// The mean of each block with what arrives straight from emitters, as 1 / (mean^2 + 0.01). Where few samples
/// tell it, of those around it too: else what is rare and bright would be judged by itself, and never seem
/// much brighter than its surroundings.
std::vector<Vec3f> weights_of(const PilotPicture& picture, const PilotArrivals& straight);

/// Curve's value for what the camera finds beside the straight.
double rest_of(const PilotPicture& picture, std::span<const Vec3f> weights);

/// Without the brightest of what the camera finds, as long as a picture of 64 samples would seldom have one of
/// them: sparks that are not there disturb nobody.
std::vector<PilotArrival> seen(const PilotArrivals& arrivals, std::span<const Vec3f> weights);

/// `pixels`: of a block.
NoiseCurves curves_of(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double pixels);

}  // namespace dg
