// density_grid.h -- density factors on a medium's coefficients, at the cell centers of a grid over the unit cube, with
// bounds for blocks of cells: delta and ratio tracking (tracking.h) step from block to block. Densities are
// interpolated trilinearly between centers, constant from the outermost centers to the faces of the cube, and 0
// outside.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/shared_array.h"
#include "math/transform.h"

namespace dg {

class DensityGrid {
  public:
    struct Size {
        std::uint32_t x, y, z;
    };
    /// `values`: x runs fastest. `space_from_unit`: transform of the unit cube to the world or to the space of a mesh.
    /// Throws Error for a wrong number of values, negative or non-finite values, and singular transforms.
    DensityGrid(Size size, SharedArray<float> values, const Affine3d& space_from_unit);

    /// Interpolated density at a point of the unit cube.
    float at(Vec3d unit) const;
    const Affine3d& unit_from_space() const { return unit_from_space_; }

    struct Bounds {
        float least, most;
    };
    /// Number of blocks along each axis, and the density bounds of a block.
    Size blocks() const { return blocks_; }
    Bounds bounds(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return bounds_[(std::size_t(z) * blocks_.y + y) * blocks_.x + x];
    }
    /// Edge of a block in the unit cube.
    Vec3d block_edge() const {
        return {double(kBlock) / size_.x, double(kBlock) / size_.y, double(kBlock) / size_.z};
    }
    static constexpr std::uint32_t kBlock = 8;   // cells along an edge of a block

  private:
    float cell(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return values_[(std::size_t(z) * size_.y + y) * size_.x + x];
    }
    Bounds find_bounds(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;

    Size size_, blocks_;
    SharedArray<float> values_;
    Affine3d unit_from_space_;
    std::vector<Bounds> bounds_;
};

/// Segment of a ray in a block, from `begin` to `end` (in lengths of its direction vector).
struct BlockStep {
    double begin, end;
    DensityGrid::Bounds bounds;
};

/// Traverses the blocks that a ray crosses, front to back. Source: Amanatides and Woo 1987, A Fast Voxel Traversal
/// Algorithm for Ray Tracing, Eurographics.
class BlockTraversal {
  public:
    /// `origin`, `direction`: in the space of the unit cube.
    BlockTraversal(const DensityGrid& grid, Vec3d origin, Vec3d direction, double begin, double end);
    std::optional<BlockStep> next();

  private:
    double crossing(int axis) const;

    const DensityGrid& grid_;
    Vec3d origin_, direction_, edge_;
    std::int64_t block_[3] = {}, count_[3];
    double here_, end_;
};

}  // namespace dg
