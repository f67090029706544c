// remap_tile.h -- tile of remap.cpp, and the SIMD kernels that fill its rows.
#pragma once
#include <cmath>

#include "post/remap.h"

namespace dg {

inline constexpr int kTileWidth = 64, kTileHeight = 32;  // multiples of cells

/// Source region of a tile, planar, with edges extended.
struct RemapRegion {
    int x0 = 0, y0 = 0, width = 0, height = 0;  // in the source
    std::vector<float> values;

    std::size_t size() const { return std::size_t(width) * height; }
    const float* plane(int channel) const { return values.data() + channel * size(); }
};

/// Positions of a row's pixels in a region: index of the first of 4 x 4 values, and fraction past
/// the second.
struct RemapRow {
    std::int32_t offset[kTileWidth];
    float tx[kTileWidth], ty[kTileWidth];
    std::int32_t here[kTileWidth];  // whether the region fills the pixel; otherwise offset is 0
};

/// Inputs for the positions of a row.
struct RemapPlaces {
    const float *dx, *dy;     // displacements, kTileWidth each
    const float *sx, *sy;     // filter stretches; null: all are 1
    int x, y, count;          // first pixel, and number of pixels inside the image
    int width, height;        // of the source
    const RemapRegion* region;
};
/// Computes positions in the region of the pixels that it fills; returns their number.
int remap_places(const RemapPlaces& p, RemapRow& row);

/// Bounding box of positions.
struct RemapBounds {
    float left = INFINITY, right = -INFINITY, up = INFINITY, down = -INFINITY;
};
/// Extends bounds by the pixels of a row inside the source; ignores stretches and region.
void remap_bounds(const RemapPlaces& p, RemapBounds& bounds);

/// Filter weights as cubics in t: the coefficient of t^k of weight i is at [k][i].
struct RemapWeights {
    float at[4][4];
};
const RemapWeights& weights_of(RemapFilter filter);

/// Channel of a region, and its output for a row: kTileWidth values.
struct RemapChannel {
    const float* plane;
    float* out;
};
/// Filters a row's pixels from a region of width `stride`.
void remap_row(std::span<const RemapChannel> channels, int stride, const RemapRow& row,
               const RemapWeights& weights);

}  // namespace dg
