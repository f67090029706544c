// source_map.h -- displacement in px from each pixel of an image to its position in the source.
//
// Lens maps are smooth: they are sampled at nodes 16 px apart and interpolated by cubics through
// four nodes. Cells where that is too inaccurate store a value per pixel. Displacements keep more
// digits in float than positions: a lens moves light by a few hundred px, not by 9000.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

struct SourceMap {
    static constexpr int kCell = 16;

    int columns = 0, rows = 0;  // number of cells
    int top =
        0;  // image row of the first cell, a multiple of kCell
    std::span<const float>
        nodes;  // (rows + 3) x (columns + 3) x 2, from one cell before the first
    std::span<const std::int32_t> exact;  // rows x columns: index into exact_cells, or -1
    std::span<const float> exact_cells;   // n x kCell x kCell x 2

    /// Throws Error unless the sizes match.
    void check() const;

    /// Displacements of the pixels of a cell, NaN where the map is undefined; rows are `stride`
    /// apart.
    void read_cell(int column, int row, float* dx, float* dy, int stride) const;

    /// Displacements at points x, y (pixel indices), interleaved, by the cubics between nodes; NaN
    /// outside of the cells and in exact cells.
    std::vector<float> displacements_at(std::span<const double> points) const;

    /// Displacements of all pixels in rows [begin, end) of an image of the given width: x and y,
    /// interleaved.
    std::vector<float> displacements(int width, int begin, int end) const;
};

/// Displacements of the pixels of a cell; NaN where the map is undefined.
struct CellMap {
    float dx[SourceMap::kCell][SourceMap::kCell], dy[SourceMap::kCell][SourceMap::kCell];

    void read(const SourceMap& map, int column, int row) {
        map.read_cell(column, row, dx[0], dy[0], SourceMap::kCell);
    }
};

}  // namespace dg
