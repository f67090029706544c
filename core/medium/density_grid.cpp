#include "medium/density_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/error.h"

namespace dg {
namespace {

std::uint32_t blocks_for(std::uint32_t cells) {
    return (cells + DensityGrid::kBlock - 1) / DensityGrid::kBlock;
}

/// Two neighbours among `count` cell centers, and the interpolation weight of the second.
struct Between {
    std::uint32_t first, second;
    float share;
};
Between between(double at, std::uint32_t count) {
    const double x = std::clamp(at * count - 0.5, 0.0, double(count - 1));
    const auto first = std::uint32_t(x);
    return {first, std::min(first + 1, count - 1), float(x - first)};
}

float mix(float a, float b, float share) { return a + (b - a) * share; }

}  // namespace

DensityGrid::DensityGrid(Size size, SharedArray<float> values, const Affine3d& space_from_unit)
    : size_(size),
      blocks_{blocks_for(size.x), blocks_for(size.y), blocks_for(size.z)},
      values_(std::move(values)),
      unit_from_space_(inverse(space_from_unit)) {
    const std::size_t wanted = std::size_t(size.x) * size.y * size.z;
    if (wanted == 0 || values_.size() != wanted)
        throw input_error("density grid", "values", std::to_string(wanted), std::to_string(values_.size()));
    if (!std::ranges::all_of(values_, [](float v) { return v >= 0 && v <= std::numeric_limits<float>::max(); }))
        throw Error("density grid: values: numbers must be finite and at least 0");
    if (!(std::abs(space_from_unit.determinant()) > 0) || !std::isfinite(unit_from_space_.determinant()))
        throw Error("density grid: transform: the matrix has no inverse");
    bounds_.reserve(std::size_t(blocks_.x) * blocks_.y * blocks_.z);
    for (std::uint32_t z = 0; z < blocks_.z; ++z)
        for (std::uint32_t y = 0; y < blocks_.y; ++y)
            for (std::uint32_t x = 0; x < blocks_.x; ++x) bounds_.push_back(find_bounds(x, y, z));
}

/// Interpolation inside a block uses the centers of its cells and of the cells next to it.
DensityGrid::Bounds DensityGrid::find_bounds(std::uint32_t bx, std::uint32_t by, std::uint32_t bz) const {
    const auto first = [](std::uint32_t block) { return block == 0 ? 0 : block * kBlock - 1; };
    const auto last = [](std::uint32_t block, std::uint32_t cells) {
        return std::min((block + 1) * kBlock, cells - 1);
    };
    Bounds found{std::numeric_limits<float>::infinity(), 0};
    for (std::uint32_t z = first(bz); z <= last(bz, size_.z); ++z)
        for (std::uint32_t y = first(by); y <= last(by, size_.y); ++y)
            for (std::uint32_t x = first(bx); x <= last(bx, size_.x); ++x) {
                found.least = std::min(found.least, cell(x, y, z));
                found.most = std::max(found.most, cell(x, y, z));
            }
    return found;
}

float DensityGrid::at(Vec3d unit) const {
    for (int k = 0; k < 3; ++k)
        if (!(unit[k] >= 0 && unit[k] <= 1)) return 0;
    const Between x = between(unit.x, size_.x), y = between(unit.y, size_.y), z = between(unit.z, size_.z);
    const auto row = [&](std::uint32_t j, std::uint32_t k) {
        return mix(cell(x.first, j, k), cell(x.second, j, k), x.share);
    };
    const auto plane = [&](std::uint32_t k) { return mix(row(y.first, k), row(y.second, k), y.share); };
    return mix(plane(z.first), plane(z.second), z.share);
}

BlockTraversal::BlockTraversal(const DensityGrid& grid, Vec3d origin, Vec3d direction, double begin, double end)
    : grid_(grid),
      origin_(origin),
      direction_(direction),
      edge_(grid.block_edge()),
      count_{grid.blocks().x, grid.blocks().y, grid.blocks().z},
      here_(begin),
      end_(end) {
    for (int k = 0; k < 3; ++k) {   // clips the ray to the cube
        if (direction[k] == 0) {
            if (!(origin[k] >= 0 && origin[k] <= 1)) end_ = here_;
            continue;
        }
        const double a = -origin[k] / direction[k], b = (1 - origin[k]) / direction[k];
        here_ = std::max(here_, std::min(a, b));
        end_ = std::min(end_, std::max(a, b));
    }
    if (!(here_ < end_)) return;
    for (int k = 0; k < 3; ++k)
        block_[k] = std::clamp(std::int64_t(std::floor((origin[k] + here_ * direction[k]) / edge_[k])), std::int64_t(0),
                               count_[k] - 1);
}

/// Ray parameter at which the ray leaves its block along an axis.
double BlockTraversal::crossing(int axis) const {
    const double d = direction_[axis];
    if (d == 0) return std::numeric_limits<double>::infinity();
    return ((double(block_[axis]) + (d > 0)) * edge_[axis] - origin_[axis]) / d;
}

std::optional<BlockStep> BlockTraversal::next() {
    if (!(here_ < end_)) return std::nullopt;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (crossing(k) < crossing(axis)) axis = k;
    const double leaves = std::min(std::max(crossing(axis), here_), end_);
    const BlockStep step{here_, leaves,
                         grid_.bounds(std::uint32_t(block_[0]), std::uint32_t(block_[1]), std::uint32_t(block_[2]))};
    here_ = leaves;
    block_[axis] += direction_[axis] > 0 ? 1 : -1;
    if (block_[axis] < 0 || block_[axis] >= count_[axis]) here_ = end_;
    return step;
}

}  // namespace dg
