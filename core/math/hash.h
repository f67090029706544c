// hash.h -- stateless integer hashes, equal on all machines.
#pragma once
#include <cstdint>

namespace dg {

/// Bijection of 64-bit integers in which each input bit flips each output bit with probability
/// ~1/2. Source: Stafford 2011, Better Bit Mixing, variant 13 (the finalizer of SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
    return v ^ (v >> 31);
}

/// Hash of several integers; depends on their order.
constexpr std::uint64_t hash64(std::uint64_t a) {
    return mix64(a + 0x9e3779b97f4a7c15ull);
}
template <typename... Rest>
constexpr std::uint64_t hash64(std::uint64_t a, std::uint64_t b, Rest... rest) {
    return hash64(hash64(a) ^ b, rest...);
}

/// n-th number of a stream, uniform in [0,1): for tests and set-up code that need no sampler.
constexpr double hash_uniform(std::uint64_t stream, std::uint64_t n) {
    return double(hash64(stream, n) >> 11) * 0x1p-53;
}

/// Reverses the bits of both 32-bit halves of a 64-bit word and swaps the halves, so that one call
/// reverses two 32-bit numbers.
constexpr std::uint64_t reverse_bits64(std::uint64_t v) {
    v = __builtin_bswap64(v);
    v = ((v >> 4) & 0x0f0f0f0f0f0f0f0full) | ((v & 0x0f0f0f0f0f0f0f0full) << 4);
    v = ((v >> 2) & 0x3333333333333333ull) | ((v & 0x3333333333333333ull) << 2);
    return ((v >> 1) & 0x5555555555555555ull) | ((v & 0x5555555555555555ull) << 1);
}
constexpr std::uint32_t reverse_bits32(std::uint32_t v) {
    v = __builtin_bswap32(v);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    return ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
}

}  // namespace dg
