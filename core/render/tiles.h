// tiles.h -- splits the drawn region into square tiles: neighbouring pixels share geometry in the caches.
#pragma once
#include <algorithm>
#include <cstdint>

#include "film/film.h"

namespace dg {

class Tiles {
  public:
    explicit Tiles(const FilmLayout& region)
        : region_(region), columns_((region.width + kSize - 1) / kSize), rows_((region.height + kSize - 1) / kSize) {}

    std::uint64_t count() const { return std::uint64_t(columns_) * std::uint64_t(rows_); }
    PixelBox operator[](std::uint64_t tile) const {
        const int x0 = region_.offset_x + int(tile % std::uint64_t(columns_)) * kSize,
                  y0 = region_.offset_y + int(tile / std::uint64_t(columns_)) * kSize;
        return {x0, y0, std::min(x0 + kSize, region_.offset_x + region_.width),
                std::min(y0 + kSize, region_.offset_y + region_.height)};
    }

  private:
    static constexpr int kSize = 16;   // px
    FilmLayout region_;
    int columns_, rows_;
};

}  // namespace dg
