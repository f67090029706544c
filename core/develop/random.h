// random.h -- random numbers of a photosite: an independent stream per seed and position.
#pragma once
#include <cmath>
#include <cstdint>

#include "math/hash.h"
#include "math/vec.h"

namespace dg {

/// Uniform and normal numbers, a pure function of seed, use and position.
class PixelRandom {
public:
    /// Key of a row; `use` separates streams at the same position. Computed once per row, since
    /// pixels are many.
    static std::uint64_t row_key(std::uint64_t seed, int use, int y) { return hash64(seed, use, y); }

    PixelRandom(std::uint64_t row_key, int x) : state_(mix64(row_key ^ std::uint64_t(std::uint32_t(x)))) {}

    /// SplitMix64: hashes of an arithmetic sequence. Source: Steele, Lea and Flood 2014, Fast
    /// splittable pseudorandom number generators.
    std::uint64_t bits() { return mix64(state_ += 0x9e3779b97f4a7c15ull); }

    /// In (0, 1), both ends excluded.
    double uniform() { return (double(bits() >> 12) + 0.5) * 0x1p-52; }

    struct Pair {
        float a, b;
    };

    /// Two independent normal numbers, of at most 5.9 in magnitude. Source: Box and Muller 1958.
    Pair normal_pair() {
        const std::uint64_t r = bits();
        const float u = (float(r >> 40) + 0.5f) * 0x1p-24f, v = float(r & 0xffffffu) * 0x1p-24f;
        const float radius = std::sqrt(-2.f * std::log(u)), angle = 2.f * kPi * v;
        return {radius * std::cos(angle), radius * std::sin(angle)};
    }

private:
    std::uint64_t state_;
};

}  // namespace dg
