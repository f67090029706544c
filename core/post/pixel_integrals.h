// pixel_integrals.h -- a raster of samples integrated over pixels of any size.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

/// Weights of samples in the integrals along one axis: pixel k is the sum of its weights
/// times the samples from `first[k]` on.
struct PixelWeights {
    std::span<const std::int32_t> first;
    std::span<const float> weights;  // as many for each pixel, one pixel after the other

    int pixels() const { return int(first.size()); }
    int taps() const { return first.empty() ? 0 : int(weights.size() / first.size()); }
};

/// Integrals of samples (rows of `columns` each): rows by `down`, columns by `across`. What lies
/// beyond the samples is 0. Throws Error if sizes do not fit.
std::vector<float> pixel_integrals(std::span<const float> samples, int columns,
                                   const PixelWeights& down, const PixelWeights& across);

}  // namespace dg
