// region.h -- regions of a frame from Python.
#pragma once
#include <string>
#include <tuple>

#include "film/film.h"
#include "math/error.h"

namespace dg::bind {

using Crop = std::tuple<int, int, int, int>;

/// Region of the pixels (x0, y0, x1, y1), end exclusive. Throws Error if it is empty.
inline FilmLayout region_of(const Crop& crop, const char* where) {
    const auto [x0, y0, x1, y1] = crop;
    const std::int64_t width = std::int64_t(x1) - x0, height = std::int64_t(y1) - y0;
    constexpr std::int64_t kMost = 1 << 20;
    if (width < 1 || height < 1 || width > kMost || height > kMost)
        throw input_error(where, "region", "at least 1 x 1 px and at most 2^20 either way",
                          std::to_string(width) + " x " + std::to_string(height));
    return {int(width), int(height), x0, y0};
}

}  // namespace dg::bind
