#include "codec/exr_predictor.h"

#include <numeric>

namespace dg {

void undo_exr_predictor(Bytes packed, std::span<std::uint8_t> pixels) {
    if (packed.size() != pixels.size())
        throw input_error("pixels", "bytes", std::to_string(packed.size()), std::to_string(pixels.size()));
    if (packed.empty()) return;
    const std::size_t half = (packed.size() + 1) / 2;
    // The sum of the even bytes' differences is the start of the odd bytes, so both halves can be
    // summed in one loop. The first byte of a block is not a difference; it starts at 128 to cancel
    // the loop's offset.
    std::uint8_t even = 128, odd = std::accumulate(packed.begin(), packed.begin() + half, std::uint8_t(128),
                                                   [](std::uint8_t sum, std::uint8_t d) { return sum + d - 128; });
    for (std::size_t i = 0; i < packed.size() / 2; ++i) {
        pixels[2 * i] = even += packed[i] - 128;
        pixels[2 * i + 1] = odd += packed[half + i] - 128;
    }
    if (packed.size() % 2) pixels.back() = even += packed[half - 1] - 128;
}

}  // namespace dg
