// vertex_random.h -- the random numbers of one vertex of a path.
#pragma once
#include "math/sampler.h"

namespace dg {

struct VertexRandom {
    float select = 0;      // which light
    Vec2f light;           // where on it
    float lobe = 0;        // which lobe of the BSDF, and which of several light samples
    Vec2f direction;
};

/// Every vertex takes the same four dimensions, so that stratification stays; those that this BSDF has
/// no use for are left out.
template <Scatters B>
VertexRandom draw_vertex(const B& bsdf, int tries, PathSampler& sampler) {
    VertexRandom u;
    const bool specular = bsdf.is_specular();
    if (tries > 0 && !specular) {
        u.select = sampler.next_1d();
        u.light = sampler.next_2d();
    } else {
        sampler.skip(2);
    }
    if (B::kOneLobe && tries < 2)
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
