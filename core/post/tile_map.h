// tile_map.h -- displacements and filter stretches of a tile's pixels for a map.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "post/remap_tile.h"
#include "post/remap_wide.h"

namespace dg {

struct TileMap {
    float dx[kTileHeight][kTileWidth], dy[kTileHeight][kTileWidth];
    float sx[kTileHeight][kTileWidth], sy[kTileHeight][kTileWidth];
    bool stretched = false;  // false: sx and sy count as 1 and are not set

    void read(const SourceMap& map, int x0, int y0, bool antialias) {
        stretched = false;
        for (int v = 0; v < kTileHeight; v += kCell)
            for (int u = 0; u < kTileWidth; u += kCell) {
                const int column = (x0 + u) / kCell, row = (y0 - map.top + v) / kCell;
                if (row < 0 || y0 + v < map.top || column >= map.columns ||
                    row >= map.rows) {
                    blank(u, v);
                    continue;
                }
                map.read_cell(column, row, dx[v] + u, dy[v] + u, kTileWidth);
                stretched = stretched || (antialias && shrinks(dx[v] + u, dy[v] + u));
            }
        if (stretched) read_stretches();
    }

  private:
    static constexpr int kCell = SourceMap::kCell;

    void blank(int u, int v) {
        for (int j = 0; j < kCell; ++j) {
            std::fill_n(dx[v + j] + u, kCell, NAN);
            std::fill_n(dy[v + j] + u, kCell, NAN);
        }
    }

    /// Squared lengths of the source steps across and down at a pixel of a cell, by differences
    /// within the cell, so that they do not depend on other cells.
    static Vec2f steps(const float* x, const float* y, int i, int j) {
        const int i0 = std::min(i, kCell - 2), j0 = std::min(j, kCell - 2);
        const int a = j * kTileWidth + i0, b = j0 * kTileWidth + i;
        const float xx = 1 + x[a + 1] - x[a], xy = x[b + kTileWidth] - x[b];
        const float yx = y[a + 1] - y[a], yy = 1 + y[b + kTileWidth] - y[b];
        return {xx * xx + xy * xy, yx * yx + yy * yy};
    }

    static bool shrinks(const float* x, const float* y) {
        float most[kCell] = {};  // per column, to allow vectorization
        const auto look = [&](int i, int j) {
            const Vec2f s = steps(x, y, i, j);
            const float larger = s.x > s.y ? s.x : s.y;
            most[i] = larger > most[i] ? larger : most[i];  // ignores NaN
        };
        for (int j = 0; j < kCell; ++j) {
            for (int i = 0; i < kCell - 1; ++i) look(i, j);
            look(kCell - 1, j);
        }
        return stretch_of(std::sqrt(*std::max_element(most, most + kCell))) > 1;
    }

    void read_stretches() {
        for (int v = 0; v < kTileHeight; ++v)
            for (int u = 0; u < kTileWidth; ++u) {
                const int v0 = v / kCell * kCell, u0 = u / kCell * kCell;
                const Vec2f s = steps(dx[v0] + u0, dy[v0] + u0, u - u0, v - v0);
                sx[v][u] = stretch_of(std::sqrt(s.x));
                sy[v][u] = stretch_of(std::sqrt(s.y));
            }
    }
};

}  // namespace dg
