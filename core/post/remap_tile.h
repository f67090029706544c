// remap_tile.h -- what remap.cpp knows of one tile, and the SIMD kernel that fills its
// rows.
#pragma once
#include "post/remap.h"

namespace dg {

inline constexpr int kTileWidth = 64, kTileHeight = 32;  // whole cells

/// The light around a tile, channel by channel, its edges continued outward.
struct RemapRegion {
    int x0 = 0, y0 = 0, width = 0, height = 0;  // in the source
    std::vector<float> values;

    const float* plane(int channel) const {
        return values.data() + std::size_t(channel) * width * height;
    }
};

/// Where the pixels of one row of a tile lie in a region: the first of 4 x 4 values, and
/// how far past the second of them.
struct RemapRow {
    std::int32_t offset[kTileWidth];
    float tx[kTileWidth], ty[kTileWidth];
    std::int32_t here[kTileWidth];  // whether the pixel is filled from the region; else
                                    // offset is 0
};

/// What places of a row depend on.
struct RemapPlaces {
    const float *dx, *dy;     // displacements, kTileWidth each
    const float *sx, *sy;     // stretches; null: all are 1
    int x, y, width, height;  // the first pixel, and the source's size
    const RemapRegion* region;
};
/// Which pixels of a row a region fills, and where they lie in it.
void remap_places(const RemapPlaces& p, RemapRow& row);

/// Weights of four values as cubics in t: coefficient of t^k of weight i is at [k][i].
struct RemapWeights {
    alignas(16) float at[4][4];
};
const RemapWeights& weights_of(RemapFilter filter);

/// Values of `count` pixels, a multiple of 4, from a plane of a region of width `stride`.
void remap_row(const float* plane, int stride, const RemapRow& row,
               const RemapWeights& weights, int count, float* out);

}  // namespace dg
