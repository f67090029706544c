// lens_mask.h -- dust and scratches: transmittance image on a plane of the lens.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/error.h"

namespace dg {

/// Transmittances in [0, 1] over a square of the given half side around the axis, as seen along the
/// view; row 0 is the top. Bilinear between pixel centres; 1 outside.
struct LensMask {
    int width = 0, height = 0;
    std::vector<float> values;   // empty: clean

    float at(float x, float y, float half_side) const {
        const float u = (x / half_side + 1) * 0.5f * float(width) - 0.5f;
        const float v = (1 - y / half_side) * 0.5f * float(height) - 0.5f;
        if (!(u > -0.5f && u < float(width) - 0.5f && v > -0.5f && v < float(height) - 0.5f)) return 1;
        const float fu = std::floor(u), fv = std::floor(v);
        const auto pixel = [&](int i, int j) {
            return values[std::size_t(std::clamp(j, 0, height - 1)) * width + std::clamp(i, 0, width - 1)];
        };
        const int i = int(fu), j = int(fv);
        const float top = pixel(i, j) + (u - fu) * (pixel(i + 1, j) - pixel(i, j));
        const float low = pixel(i, j + 1) + (u - fu) * (pixel(i + 1, j + 1) - pixel(i, j + 1));
        return top + (v - fv) * (low - top);
    }
};

inline void check_mask(const LensMask& mask, const char* what) {
    for (const float value : mask.values)
        if (!(value >= 0 && value <= 1))
            throw input_error("exact lens", what, "values of 0 to 1", std::to_string(value));
}

/// Masks on the front surface and at the iris, scaled to the clear diameters of front and stop.
struct LensDirt {
    LensMask front, iris;
};

}  // namespace dg
