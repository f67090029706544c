// pixel_integrals.h -- integrals of a sample raster over pixels of any size.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

/// Weights along an axis: pixel k is the sum of its weights times the samples from `first[k]` on.
struct PixelWeights {
    std::span<const std::int32_t> first;
    std::span<const float> weights;  // equal number for each pixel, pixel by pixel

    int pixels() const { return int(first.size()); }
    int taps() const { return first.empty() ? 0 : int(weights.size() / first.size()); }
};

/// Integrates samples (rows of `columns` each) by `down` over rows and `across` over columns.
/// Samples outside of the raster are 0. Throws Error if sizes do not match.
std::vector<float> pixel_integrals(std::span<const float> samples, int columns,
                                   const PixelWeights& down, const PixelWeights& across);

}  // namespace dg
