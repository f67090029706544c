// sampler.h -- random numbers of a path, by purpose.
#pragma once
#include <cstdint>

#include "math/sobol.h"
#include "math/vec.h"

namespace dg {

/// Camera dimensions of a path, jointly stratified over the sample index.
struct CameraRandom {
    Vec2f film, lens;
    float time, lambda;
};

/// Owen-scrambled Sobol points. Each pixel has its own scramble (from pixel and seed); the sample
/// index runs through the sequence, so any range [a, b) of indices can be rendered anywhere, in any
/// order. The six camera dimensions are followed by 1D and 2D pads, each a shuffled and scrambled
/// sequence. The lens uses the first two coordinates (a (0,2)-sequence), since noise is most
/// visible in defocused highlights. Source: Burley 2020, Practical Hash-based Owen Scrambling, JCGT
/// 9(4).
class PathSampler {
  public:
    PathSampler(int pixel_x, int pixel_y, std::uint32_t sample_index, std::uint64_t seed)
        : seed_(hash64(seed, std::uint64_t(std::uint32_t(pixel_y)) << 32 |
                                 std::uint32_t(pixel_x))),
          index_(sample_index),
          reversed_index_(reverse_bits32(sample_index)) {}

    CameraRandom camera() const;

    /// Skips the next n dimensions, so that later ones keep their index.
    void skip(int n) { dimension_ += n; }

    /// In [0,1).
    float next_1d() {
        const Pad pad = next_pad();
        return unit_float(reverse_bits32(owen_scramble_reversed(pad.index, pad.seed_x)));
    }

    /// In [0,1)^2.
    Vec2f next_2d() {
        const Pad pad = next_pad();
        const std::uint32_t x = owen_scramble_reversed(pad.index, pad.seed_x);
        const std::uint32_t y =
            owen_scramble_reversed(sobol_second_reversed(pad.index), pad.seed_y);
        const std::uint64_t both = reverse_bits64(std::uint64_t(y) << 32 | x);
        return {unit_float(std::uint32_t(both >> 32)), unit_float(std::uint32_t(both))};
    }

  private:
    struct Pad {
        std::uint32_t index, seed_x, seed_y;
    };

    /// An Owen scramble of the index is a shuffle that preserves aligned blocks of 2^k indices:
    /// pads become independent, and every block stays stratified.
    Pad next_pad() {
        const std::uint64_t h = mix64(seed_ + ++dimension_ * 0x9e3779b97f4a7c15ull);
        const std::uint32_t low(h), high(h >> 32);
        return {reverse_bits32(owen_scramble_reversed(reversed_index_, low)), high,
                std::uint32_t((h * 0xd1342543de82ef95ull) >> 32)};
    }

    std::uint64_t seed_;
    std::uint32_t index_, reversed_index_;
    std::uint64_t dimension_ = 0;
};

}  // namespace dg
