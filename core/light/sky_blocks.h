// sky_blocks.h -- chooses directions in a sky's picture by weight, in two steps.
//
// The cells of the picture (sky_grid.h) are joined to blocks, some 2 degrees wide in large pictures, so that a table of
// all blocks stays in a core's cache. Blocks are chosen by their weight. A block with little contrast is *even*: a
// direction in it is uniform, and the density follows its mean weight. In other blocks, such as those with a sun, a
// cell is chosen by its weight from a second table, and a direction in the cell by weight. So the density is
//   weight / integral of the weight over the sphere,
// with the weight in the cell, or the mean of the block if it is even.
#pragma once
#include <cstdint>
#include <vector>

#include "light/sky_grid.h"
#include "math/grid_cdf.h"

namespace dg {

class SkyBlocks {
  public:
    static constexpr std::size_t kMostBytes = 256 * 1024;   // of the table of blocks

    SkyBlocks() = default;
    explicit SkyBlocks(const SkyGrid& grid);

    /// Integral of the weight over the sphere; 0: black.
    double total() const { return total_; }
    /// A direction with the density weight / total(). `grid`: the same as of the constructor.
    SkyDraw sample(const SkyGrid& grid, Vec2f u) const;
    /// The weight of sample() at a direction in the cell `at`.
    float weight(const SkyGrid& grid, const SkyGrid::Place& at, Vec3f direction) const;

    /// Cells along a side of a block.
    int side() const { return side_; }
    /// Whether the block of a cell is even.
    bool is_even(int c, int r) const { return blocks_[block_of(c, r)].fine == 0; }
    /// Memory of the tables.
    std::size_t bytes() const {
        return blocks_.size() * sizeof(Block) + choice_.bytes() + fine_.size() * sizeof(std::uint32_t);
    }

  private:
    struct Block {
        float weight;         // mean
        std::uint32_t fine;   // 0: even; else 1 + index of its table of cells
    };
    struct Sum;
    int block_of(int c, int r) const { return r / side_ * across_ + c / side_; }
    /// The columns or rows of cells of a column or row of blocks: the first, and the first beyond it.
    std::array<int, 2> part(int index, int cells) const {
        return {index * side_, std::min((index + 1) * side_, cells)};
    }
    Sum sum_of(const SkyGrid& grid, GridCell block) const;
    std::size_t fine_size() const { return grid_cdf_size(side_, side_); }
    void fill_fine(const SkyGrid& grid, GridCell block, std::uint32_t* table) const;

    int side_ = 1, across_ = 0, down_ = 0;
    double total_ = 0;
    std::vector<Block> blocks_;            // across_ x down_
    GuidedGrid choice_;                    // of a block
    std::vector<std::uint32_t> fine_;      // tables of side_ x side_ cells, for each block that is not even
};

}  // namespace dg
