#include "post/pixel_integrals.h"

#include <algorithm>
#include <cstdint>

#include "math/error.h"

namespace dg {
namespace {

void check(const PixelWeights& w) {
    if (w.first.empty() || w.weights.size() % w.first.size() != 0)
        throw Error("pixel_integrals: all pixels must have the same number of weights");
}

/// Sums the rows of a pixel, before its columns are summed.
void sum_rows(std::span<const float> samples, int columns, const PixelWeights& down, int pixel,
              std::vector<float>& line) {
    const int rows = int(samples.size() / columns), taps = down.taps();
    std::fill(line.begin(), line.end(), 0.f);
    for (int t = 0; t < taps; ++t) {
        const std::int64_t row = std::int64_t(down.first[pixel]) + t;
        const float weight = down.weights[std::size_t(pixel) * taps + t];
        if (row < 0 || row >= rows || weight == 0) continue;
        const float* from = samples.data() + std::size_t(row) * columns;
        for (int x = 0; x < columns; ++x) line[x] += weight * from[x];
    }
}

float sum_columns(const std::vector<float>& line, const PixelWeights& across, int pixel) {
    const std::int64_t taps = across.taps(), first = across.first[pixel];
    const float* weights = across.weights.data() + std::size_t(pixel) * taps;
    const std::int64_t begin = std::max<std::int64_t>(0, -first);
    const std::int64_t end = std::min(taps, std::int64_t(line.size()) - first);
    float sum = 0;
    for (std::int64_t t = begin; t < end; ++t) sum += weights[t] * line[first + t];
    return sum;
}

}  // namespace

std::vector<float> pixel_integrals(std::span<const float> samples, int columns,
                                   const PixelWeights& down, const PixelWeights& across) {
    check(down);
    check(across);
    if (columns < 1 || samples.size() % columns != 0)
        throw Error("pixel_integrals: wanted whole rows of samples");
    std::vector<float> out, line(columns);
    out.reserve(std::size_t(down.pixels()) * across.pixels());
    for (int y = 0; y < down.pixels(); ++y) {
        sum_rows(samples, columns, down, y, line);
        for (int x = 0; x < across.pixels(); ++x) out.push_back(sum_columns(line, across, x));
    }
    return out;
}

}  // namespace dg
