// direct_light.h -- a light sample at a vertex, with its MIS weight against BSDF sampling.
#pragma once
#include "material/bsdf_sample.h"
#include "scene/scene.h"

namespace dg {

/// Power heuristic with exponent 2. Source: Veach 1997, Robust Monte Carlo Methods, section 9.2.4.
inline float power_heuristic(float pdf, float other) {
    const float ratio = other / pdf;   // a ratio, as the square of a large pdf overflows
    return 1.f / (1.f + ratio * ratio);
}

struct DirectLight {
    LightSample light;
    Evaluation f;      // BSDF or phase function toward the light
    float weight;      // factor on f times the radiance, if the light is unoccluded
};

}  // namespace dg
