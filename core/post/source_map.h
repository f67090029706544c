// source_map.h -- for each pixel of a picture, how far away its light lies in the source,
// px.
//
// Maps of lenses are smooth: they are given at nodes 16 px apart, and cubics through four
// nodes follow them between. Cells where that is not good enough carry a value for every
// pixel. Displacements, and not places, because a float keeps seven digits: of the few
// hundred px by which a lens moves light, and not of 9000.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

struct SourceMap {
    static constexpr int kCell = 16;

    int columns = 0, rows = 0;  // cells
    int top =
        0;  // row of the picture at which the first cell begins; a multiple of kCell
    std::span<const float>
        nodes;  // (rows + 3) x (columns + 3) x 2, from one cell before the first
    std::span<const std::int32_t> exact;  // rows x columns: which of exact_cells, or -1
    std::span<const float> exact_cells;   // n x kCell x kCell x 2

    /// Throws Error unless the sizes agree.
    void check() const;

    /// Displacements of the pixels of one cell, NaN where the map is not defined; rows are `stride`
    /// apart.
    void read_cell(int column, int row, float* dx, float* dy, int stride) const;

    /// At any points x, y (pixels by index), point by point, by the cubics between nodes;
    /// NaN outside of the cells, and where a cell is exact.
    std::vector<float> displacements_at(std::span<const double> points) const;

    /// Displacements of all pixels of rows [begin, end) of a picture so wide: x and y, pixel by pixel.
    std::vector<float> displacements(int width, int begin, int end) const;
};

/// Displacements of the pixels of one cell; NaN where the map is not defined.
struct CellMap {
    float dx[SourceMap::kCell][SourceMap::kCell], dy[SourceMap::kCell][SourceMap::kCell];

    void read(const SourceMap& map, int column, int row) {
        map.read_cell(column, row, dx[0], dy[0], SourceMap::kCell);
    }
};

}  // namespace dg
