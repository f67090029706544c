// light_plan.h -- numbers of light paths to trace from the emitters to the film, in addition to camera paths. The
// balance heuristic combines both (light_sharing.h).
#pragma once

namespace dg {

/// Upper limit for either kind. No picture needs as many, and 64-bit indices do not overflow.
inline constexpr double kMostLightPaths = 1e9;

/// Light paths per sample index, for the whole frame. With 0 the picture is bit-identical to a picture rendered without
/// this feature, at the same speed.
struct LightPlan {
    double m1 = 0;   // from an emitter directly to the lens
    double m2 = 0;   // with two or more surface vertices; the camera computes direct light
    bool sky = true;   // m1 includes the sky; false if the lens cannot see the sky

    bool off() const { return m1 <= 0 && m2 <= 0; }
    friend LightPlan operator*(LightPlan plan, double factor) {
        return {plan.m1 * factor, plan.m2 * factor, plan.sky};
    }
};

/// Technique that renders light which both camera and light paths can find, for comparison in tests. Light that only
/// one of them can find is always rendered. `rest`: only that light is rendered.
enum class Technique { both, camera, light, rest };

}  // namespace dg
