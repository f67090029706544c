// vertex_random.h -- the random numbers of one vertex of a path.
#pragma once
#include "math/sampler.h"

namespace dg {

struct VertexRandom {
    float select = 0;      // the light
    Vec2f light;           // the point on the light
    float lobe = 0;        // the lobe of the BSDF, and the pick among several light samples
    Vec2f direction;
};

/// Every vertex consumes the same four dimensions, which keeps samples stratified; dimensions that the BSDF does not
/// need are skipped.
template <Scatters B>
VertexRandom draw_vertex(const B& bsdf, int candidates, PathSampler& sampler) {
    VertexRandom u;
    const bool specular = bsdf.is_specular();
    if (candidates > 0 && !specular) {
        u.select = sampler.next_1d();
        u.light = sampler.next_2d();
    } else {
        sampler.skip(2);
    }
    if (B::kOneLobe && candidates < 2)
        sampler.skip(1);
    else
        u.lobe = sampler.next_1d();
    if (specular)
        sampler.skip(1);
    else
        u.direction = sampler.next_2d();
    return u;
}

}  // namespace dg
