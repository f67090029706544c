// light_plan.h -- how much light is followed from the emitters to the film, beside the paths from the
// camera. Both find the same light, and share it by the balance heuristic (light_sharing.h).
#pragma once

namespace dg {

/// Largest number of either kind: what no picture needs, and what indices of 64 bits bear.
inline constexpr double kMostLightPaths = 1e9;

/// Light paths per sample index, for the whole frame; 0: none, and the picture has the bits and the speed
/// that it has without them.
struct LightPlan {
    double m1 = 0;   // from an emitter straight to the lens
    double m2 = 0;   // over two surfaces or more; direct light is the camera's
    bool sky = true;   // straight from the sky, too: not where the lens does not see it

    bool off() const { return m1 <= 0 && m2 <= 0; }
    friend LightPlan operator*(LightPlan plan, double factor) {
        return {plan.m1 * factor, plan.m2 * factor, plan.sky};
    }
};

/// Who draws what both could find: tests hold one against the other. What only one can find is always its
/// own. rest: nobody does, which leaves that.
enum class Technique { both, camera, light, rest };

}  // namespace dg
