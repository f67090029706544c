// density_grid.h -- factors on a medium's coefficients, at the centres of cells that fill the unit cube, and bounds of
// them in blocks of cells: delta and ratio tracking (tracking.h) step from block to block, each with its own bounds.
// Between centres the factors are linear. From the outermost centres to the faces of the cube they stay as they are;
// outside they are 0.
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
    /// `values`: x runs fastest. `space_from_unit`: where the unit cube lies, in the world or in the space of a mesh.
    /// Throws Error for another number of values, values that are negative or not finite, a transform without inverse.
    DensityGrid(Size size, SharedArray<float> values, const Affine3d& space_from_unit);

    /// At a point of the unit cube.
    float at(Vec3d unit) const;
    const Affine3d& unit_from_space() const { return unit_from_space_; }

    struct Bounds {
        float least, most;
    };
    /// Blocks along each axis, and the bounds of all factors within one of them.
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

/// The part of a ray in one block: from `begin` to `end` (units of its direction).
struct BlockStep {
    double begin, end;
    DensityGrid::Bounds bounds;
};

/// The blocks that a ray crosses, one after the other. Source: Amanatides and Woo 1987, A Fast Voxel Traversal
/// Algorithm for Ray Tracing, Eurographics.
class BlockWalk {
  public:
    /// Origin and direction in the unit cube's space.
    BlockWalk(const DensityGrid& grid, Vec3d origin, Vec3d direction, double begin, double end);
    std::optional<BlockStep> next();

  private:
    double crossing(int axis) const;

    const DensityGrid& grid_;
    Vec3d origin_, direction_, edge_;
    std::int64_t block_[3] = {}, count_[3];
    double here_, end_;
};

}  // namespace dg
