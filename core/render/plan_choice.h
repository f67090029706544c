// plan_choice.h -- chooses the number of light paths that minimizes cost x error, from the samples of a pilot.
//
// Each arrival of a light path f gives its value y = f / p_light, for one path per sample, and the ratio
// r = p_camera / p_light of the densities, per sample, with which the two techniques draw f. Where r is small, camera
// paths seldom find f but light paths do, so arrivals of light paths suffice to estimate the variance of camera paths.
// With m light paths per sample, combined by the balance heuristic, the second moment of both techniques is
//     S(m) = int f^2 (p_camera + k m p_light) / (p_camera + m p_light)^2
//          = E_light[ y^2 (r + k m) / (r + m)^2 ].
// k is the sum of squares of an arrival that is spread over several pixels, relative to an arrival in a single pixel
// (k = 1 for camera samples). The camera's contribution has the mean C(m) = E_light[ y r / (r + m) ], and a sample has
// the variance
//     V(m) = S(m) - C(m)^2
// (arrivals are a Poisson process, so their squared mean is not subtracted). m = 0 is the camera alone. One set of
// arrivals gives V for every m. Source: Veach 1997, section 9.2 (the multi-sample model).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"
#include "transport/sharing/light_plan.h"

namespace dg {

/// An arrival of a light path of the pilot.
struct PilotArrival {
    std::uint32_t block;
    Vec3f value;           // y: light added to a single pixel at one path per sample, linear Rec.709
    float ratio;           // r
    float spread = 1;      // k
    std::uint32_t path = 0;   // index of the light path
};

/// The arrivals of a number of light paths of one kind.
struct PilotArrivals {
    std::span<const PilotArrival> all;
    std::uint64_t paths = 0;
};

/// Mean and variance of a camera sample in a block of pixels, without light that direct light paths can find.
struct PilotBlock {
    Vec3f mean{0, 0, 0}, variance{0, 0, 0};
};

/// The pilot picture's blocks, row by row.
struct PilotPicture {
    std::span<const PilotBlock> blocks;
    int columns = 1;
    double pixels = 1;   // per block
};

/// Costs in a common unit.
struct PlanCosts {
    double camera = 1;          // one sample of every pixel
    double sharing = 0;         // additional cost per sample of MIS with light paths
    double sharing_bounced = 0; // additional cost per sample of MIS with bounced light paths
    double straight = 0;        // a light path directly to the lens
    double bounced = 0;         // a light path with bounces
};

struct PlanChoice {
    LightPlan plan;
    /// False: more arrivals could turn the decision for or against light paths.
    bool sure = true;
};

/// Minimizes cost x error, with the error as the mean over pixels and channels of variance / (mean^2 + 0.01), as in
/// --noise. A sample with light paths costs at most four times a sample without; bounced paths may cost as much as the
/// camera sample. The number of direct paths is chosen first, against the variance that the camera samples have seen of
/// the remaining light: fireflies that the pilot missed must not prevent direct paths, which clean up discs of light.
/// Then bounced paths are chosen. Either kind must gain more than kWorth by two standard errors of a jackknife over
/// eighths of the paths, so that no single path decides.
PlanChoice choose_plan(const PilotPicture& picture, const PilotArrivals& straight,
                       const PilotArrivals& bounced, const PlanCosts& costs);

/// Least ratio of cost x error without a plan to cost x error with it.
inline constexpr double kWorth = 1.1;

}  // namespace dg
