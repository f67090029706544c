// srgb.h -- conversion between 8-bit codes and linear light. Source: IEC 61966-2-1.
#pragma once
#include <array>
#include <cstdint>

namespace dg {

/// Linear light of the 256 sRGB codes and of the 256 linear codes.
struct Decode {
    std::array<float, 256> srgb, linear;
    Decode();
};
extern const Decode kDecode;

/// The code with the light nearest to v (0 .. 1).
std::uint8_t srgb_code(float v);

/// Integer tables for means of four codes: the light of each code, and the code of a sum of four.
struct SrgbSums {
    static constexpr int kOne = 16383;  // light of code 255; the darkest codes are 5 apart
    std::array<std::uint16_t, 256> light;
    std::array<std::uint8_t, 4 * kOne + 1> code;
};
const SrgbSums& srgb_sums();

}  // namespace dg
