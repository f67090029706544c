// remap_wide.h -- filtering of single pixels with a stretched filter.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"
#include "post/remap.h"

namespace dg {

/// Largest stretch; beyond it a pixel samples only part of its footprint.
inline constexpr float kMaxStretch = 16;

/// Stretches below 9/8 are invisible and would cost time; they are blended in up to 5/4.
inline float stretch_of(float scale) {
    if (!(scale > 1.125f)) return 1;
    return std::min(scale < 1.25f ? 2 * scale - 1.25f : scale, kMaxStretch);
}

/// Position along an axis: pixel, fraction to the next, and stretch.
struct WidePlace {
    int at;
    float rest, stretch;
};

inline const float* source_row(const RemapSource& s, int y) {
    const int row = std::clamp(y, 0, s.height - 1) - s.first;
    if (row < 0 || row >= s.rows())
        throw input_error("remap", "rows", "all rows that the map reads",
                          "no row " + std::to_string(y));
    return s.values.data() + std::size_t(row) * s.width * s.channels;
}

/// Weight of Keys' cubic (a = -1/2), or of a tent.
inline float filter_weight(RemapFilter filter, float x) {
    x = std::abs(x);
    if (filter == RemapFilter::linear) return std::max(1 - x, 0.f);
    if (x < 1) return (1.5f * x - 2.5f) * x * x + 1;
    return x < 2 ? ((-0.5f * x + 2.5f) * x - 4) * x + 2 : 0;
}

struct WideWeights {
    int first, count = 0;
    float weight[4 * int(kMaxStretch) + 2];

    WideWeights(const WidePlace& p, RemapFilter filter) {
        const float reach = 2 * p.stretch;
        const int low = int(std::ceil(p.rest - reach)),
                  high = int(std::floor(p.rest + reach));
        first = p.at + low;
        float sum = 0;
        for (int i = low; i <= high; ++i)
            sum += weight[count++] =
                filter_weight(filter, (float(i) - p.rest) / p.stretch);
        for (int k = 0; k < count; ++k) weight[k] /= sum;
    }
};

inline float sample_wide(const RemapSource& s, int channel, const WidePlace& x,
                         const WidePlace& y, RemapFilter filter) {
    const WideWeights wx(x, filter), wy(y, filter);
    float sum = 0, low = INFINITY, high = -INFINITY;
    for (int j = 0; j < wy.count; ++j) {
        if (wy.weight[j] == 0) continue;
        const float* line = source_row(s, wy.first + j);
        float along = 0;
        for (int i = 0; i < wx.count; ++i) {
            const float value =
                line[std::size_t(std::clamp(wx.first + i, 0, s.width - 1)) * s.channels +
                     channel];
            along += wx.weight[i] * value;
            low = std::min(low, value), high = std::max(high, value);
        }
        sum += wy.weight[j] * along;
    }
    return std::isnan(sum) ? sum : std::clamp(sum, low, std::max(low, high));
}

}  // namespace dg
