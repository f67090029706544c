// sobol.h -- Sobol points and Owen scrambling on bit-reversed integers.
//
// All words are REVERSED: bit 0 is the first binary digit after the point. Then the first
// coordinate of point i is i, and Owen scrambling, in which a digit depends on the digits before
// it, is a function in which low bits affect high bits, like + and *.
#pragma once
#include <array>
#include <cstdint>

#include "math/hash.h"

namespace dg {

/// Owen's nested uniform scramble of a reversed word, hashed from `seed`. Sources: Laine and Karras
/// 2011, Stratified Sampling for Stochastic Transparency (method); Burley 2020, JCGT 9(4); Vegdahl
/// 2021, Building a Better LK Hash (constants).
constexpr std::uint32_t owen_scramble_reversed(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// Second Sobol coordinate, reversed. Its direction numbers are the rows of Pascal's triangle mod
/// 2: reversed, the coordinate is the polynomial with the bits of i as coefficients, evaluated at
/// (x + 1) over GF(2). Each line shifts by 1 in blocks: L + x^s H -> (L + H) + x^s H, because (x +
/// 1)^s = x^s + 1.
constexpr std::uint32_t sobol_second_reversed(std::uint32_t i) {
    i ^= i >> 16;
    i ^= (i >> 8) & 0x00ff00ffu;
    i ^= (i >> 4) & 0x0f0f0f0fu;
    i ^= (i >> 2) & 0x33333333u;
    return i ^ ((i >> 1) & 0x55555555u);
}

/// Primitive polynomial (degree, inner coefficients) and initial numbers of a Sobol coordinate.
struct SobolSeed {
    int degree;
    std::uint32_t coefficients;
    std::array<std::uint32_t, 4> initial;
};

/// Coordinates 3 to 6. Source: Joe and Kuo 2008, Constructing Sobol Sequences with Better
/// Two-Dimensional Projections, SIAM J. Sci. Comput. 30(5), table new-joe-kuo-6.21201.
inline constexpr std::array<SobolSeed, 4> kSobolSeeds{{{2, 1, {1, 3, 0, 0}},
                                                       {3, 1, {1, 3, 1, 0}},
                                                       {3, 2, {1, 1, 1, 0}},
                                                       {4, 1, {1, 1, 3, 3}}}};

/// Reversed direction numbers: [index bit][coordinate 3..6], by the recurrence of Bratley and Fox
/// 1988.
constexpr std::array<std::array<std::uint32_t, 4>, 32> sobol_directions() {
    std::array<std::array<std::uint32_t, 4>, 32> table{};
    for (int d = 0; d < 4; ++d) {
        const SobolSeed& p = kSobolSeeds[d];
        std::array<std::uint32_t, 32> v{};
        for (int i = 0; i < 32; ++i) {
            if (i < p.degree) {
                v[i] = p.initial[i] << (31 - i);
            } else {
                v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
                for (int k = 1; k < p.degree; ++k)
                    if ((p.coefficients >> (p.degree - 1 - k)) & 1) v[i] ^= v[i - k];
            }
            table[i][d] = reverse_bits32(v[i]);
        }
    }
    return table;
}

/// First 24 bits as a float in [0,1): all values are exact, the largest is 1 - 2^-24.
inline float unit_float(std::uint32_t bits) {
    return float(std::int32_t(bits >> 8)) * 0x1p-24f;
}

}  // namespace dg
