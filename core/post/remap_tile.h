// remap_tile.h -- what remap.cpp knows of one tile, and the SIMD kernels that fill its
// rows.
#pragma once
#include <cmath>

#include "post/remap.h"

namespace dg {

inline constexpr int kTileWidth = 64, kTileHeight = 32;  // whole cells

/// The light around a tile, channel by channel, its edges continued outward.
struct RemapRegion {
    int x0 = 0, y0 = 0, width = 0, height = 0;  // in the source
    std::vector<float> values;

    std::size_t size() const { return std::size_t(width) * height; }
    const float* plane(int channel) const { return values.data() + channel * size(); }
};

/// Where the pixels of one row of a tile lie in a region: the first of 4 x 4 values, and
/// how far past the second of them.
struct RemapRow {
    std::int32_t offset[kTileWidth];
    float tx[kTileWidth], ty[kTileWidth];
    std::int32_t here[kTileWidth];  // whether the pixel is filled from the region; else
                                    // offset is 0
};

/// Inputs of the places of a row.
struct RemapPlaces {
    const float *dx, *dy;     // displacements, kTileWidth each
    const float *sx, *sy;     // stretches; null: all are 1
    int x, y, count;          // the first pixel, and how many belong to the picture
    int width, height;        // the source's size
    const RemapRegion* region;
};
/// Which pixels of a row a region fills, and where they lie in it. Returns how many.
int remap_places(const RemapPlaces& p, RemapRow& row);

/// Least and greatest places.
struct RemapBounds {
    float left = INFINITY, right = -INFINITY, up = INFINITY, down = -INFINITY;
};
/// Extends bounds by the pixels of a row that lie in the source; stretches and region
/// have no say.
void remap_bounds(const RemapPlaces& p, RemapBounds& bounds);

/// Weights of four values as cubics in t: coefficient of t^k of weight i is at [k][i].
struct RemapWeights {
    float at[4][4];
};
const RemapWeights& weights_of(RemapFilter filter);

/// A channel of a region, and where its values of a row go: kTileWidth of them.
struct RemapChannel {
    const float* plane;
    float* out;
};
/// Values of a row's pixels from a region of width `stride`.
void remap_row(std::span<const RemapChannel> channels, int stride, const RemapRow& row,
               const RemapWeights& weights);

}  // namespace dg
