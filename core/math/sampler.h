// sampler.h -- the random numbers of one path, by purpose.
#pragma once
#include <cstdint>

#include "math/vec.h"

namespace dg {

/// The first six dimensions of a path; jointly stratified over the sample index.
struct CameraRandom {
    Vec2f film, lens;
    float time, lambda;
};

/// Owen-scrambled Sobol points. A pixel has its own scramble (from pixel and seed); the sample index
/// runs through the sequence, so any range [a, b) of indices can be drawn anywhere, in any order.
/// After the six camera dimensions, 1D and 2D pads follow, each a shuffled and scrambled sequence.
/// Source: Burley 2020, Practical Hash-based Owen Scrambling, JCGT 9(4).
class PathSampler {
  public:
    PathSampler(int pixel_x, int pixel_y, std::uint32_t sample_index, std::uint64_t seed);

    CameraRandom camera() const;
    float next_1d();   // in [0,1)
    Vec2f next_2d();   // in [0,1)^2

  private:
    std::uint32_t index_, seed_, dimension_ = 0;
};

}  // namespace dg
