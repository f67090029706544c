// sampler.cpp -- the six camera dimensions of a path.
#include "math/sampler.h"

#include <bit>

namespace dg {
namespace {

using Lanes [[gnu::vector_size(16)]] = std::uint32_t;

constexpr auto kDirections = sobol_directions();

/// Coordinates 3 to 6 of point i, bit-reversed: XOR of the direction numbers of its set bits.
Lanes sobol_rest_reversed(std::uint32_t i) {
    Lanes sum{};
    for (; i != 0; i &= i - 1) {
        const auto& d = kDirections[std::countr_zero(i)];
        sum ^= Lanes{d[0], d[1], d[2], d[3]};
    }
    return sum;
}

/// Scrambles two bit-reversed coordinates with the halves of `seed`, and converts them to float.
Vec2f scrambled(std::uint32_t x, std::uint32_t y, std::uint64_t seed) {
    const std::uint64_t both = reverse_bits64(
        std::uint64_t(owen_scramble_reversed(y, std::uint32_t(seed >> 32))) << 32 |
        owen_scramble_reversed(x, std::uint32_t(seed)));
    return {unit_float(std::uint32_t(both >> 32)), unit_float(std::uint32_t(both))};
}

}  // namespace

CameraRandom PathSampler::camera() const {
    const Lanes rest = sobol_rest_reversed(index_);
    const std::uint64_t step = 0x9e3779b97f4a7c15ull;
    const Vec2f lens =
        scrambled(index_, sobol_second_reversed(index_), mix64(seed_ - 1 * step));
    const Vec2f film = scrambled(rest[0], rest[1], mix64(seed_ - 2 * step));
    const Vec2f other = scrambled(rest[2], rest[3], mix64(seed_ - 3 * step));
    return {film, lens, other.y, other.x};
}

}  // namespace dg
