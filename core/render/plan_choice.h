// plan_choice.h -- how many light paths are worth their time, from a pilot's few samples.
//
// What a path f is worth to the camera and to light is known at each arrival of a light path: its value
// y = f / p_light, as one of one path per sample, and the ratio r = p_camera / p_light of the densities
// with which the two would have drawn it, per sample. Camera rays find it rarely where r is small; yet
// light finds it, so light paths alone tell what camera rays would suffer. With m light paths per sample,
// shared by the balance heuristic, the second moment of both techniques together is
//     S(m) = int f^2 (p_camera + k m p_light) / (p_camera + m p_light)^2
//          = E_light[ y^2 (r + k m) / (r + m)^2 ],
// k being what is left of the squares of an arrival that several pixels share (camera samples have one);
// the mean of the camera's share is C(m) = E_light[ y r / (r + m) ], and the variance of a sample
//     V(m) = S(m) - C(m)^2
// (arrivals are independent: of theirs nothing is taken off). m = 0 is the camera alone. So one set of
// arrivals answers for every m. Source: Veach 1997, section 9.2 (the multi-sample model).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"
#include "transport/sharing/light_plan.h"

namespace dg {

/// An arrival of a light path of the pilot.
struct PilotArrival {
    std::uint32_t block;   // where
    Vec3f value;           // y: linear Rec.709 that it would add to one pixel, were one path drawn per sample
    float ratio;           // r
    float spread = 1;      // k
    std::uint32_t path = 0;   // of all, in the order in which they are drawn
};

/// The arrivals of so many light paths of one kind.
struct PilotArrivals {
    std::span<const PilotArrival> all;
    std::uint64_t paths = 0;
};

/// Light that the camera alone finds in a block of pixels, where it leaves emitters that light paths reach
/// straight away to these: mean and variance of one sample.
struct PilotBlock {
    Vec3f mean{0, 0, 0}, variance{0, 0, 0};
};

/// The picture in blocks, row by row.
struct PilotPicture {
    std::span<const PilotBlock> blocks;
    int columns = 1;
    double pixels = 1;   // of a block
};

/// Costs of things, in any one unit.
struct PlanCosts {
    double camera = 1;          // one sample of every pixel
    double sharing = 0;         // what is added to it where light paths share in what it finds
    double sharing_bounced = 0; // and where those with bounces do
    double straight = 0;        // a light path that goes straight to the lens
    double bounced = 0;         // a light path with bounces, to its end
};

/// The numbers of light paths for which cost x error is least, error being the mean over pixels and
/// channels of variance / (mean^2 + 0.01), as of --noise; at most four times the cost of a sample without,
/// of which paths with bounces may be one. Paths straight to the lens first, against what the camera's few
/// samples have seen of the rest: sparks that these have not met are no reason to leave discs of light to
/// noise. Then those with bounces. Either must gain more than kWorth by two standard errors, which come of
/// leaving out an eighth of the paths in turn (jackknife): one lucky path is no reason.
LightPlan choose_plan(const PilotPicture& picture, const PilotArrivals& straight,
                      const PilotArrivals& bounced, const PlanCosts& costs);

/// Cost x error without over that with a plan must be above this.
inline constexpr double kWorth = 1.1;

}  // namespace dg
