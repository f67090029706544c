#include "light/sky_blocks.h"

namespace dg {

namespace {

// Bounds of an even block: variance of the weight over the square of its mean, and largest weight over mean. They
// bound the loss where only a part of the sky is seen: the second moment of weight / density grows by at most
// kMostVariance, and no sample weighs more than kMostPeak means.
constexpr double kMostVariance = 0.2, kMostPeak = 3;

/// Mean square of a bilinear function over its unit square.
double mean_square(const std::array<float, 4>& k) {
    const auto product = [](double a, double b, double c, double d) {
        return (2 * (a * c + b * d) + a * d + b * c) / 6;
    };
    return (product(k[0], k[1], k[0], k[1]) + product(k[0], k[1], k[2], k[3]) + product(k[2], k[3], k[2], k[3])) / 3;
}

int parts(int cells, int side) {
    return (cells + side - 1) / side;
}

}  // namespace

/// Sums over the cells of a block.
struct SkyBlocks::Sum {
    double weight = 0, square = 0, solid_angle = 0, peak = 0;   // square: integral of the squared weight

    double mean() const { return weight / solid_angle; }
    bool is_even() const {
        return peak <= kMostPeak * mean() && square * solid_angle <= (1 + kMostVariance) * weight * weight;
    }
};

SkyBlocks::SkyBlocks(const SkyGrid& grid) {
    const auto bytes = [&](int side) {
        const int across = parts(grid.width, side), down = parts(grid.rows(), side);
        return std::size_t(across) * down * sizeof(Block) + GuidedGrid::bytes(across, down);
    };
    while (bytes(side_) > kMostBytes) ++side_;
    across_ = parts(grid.width, side_), down_ = parts(grid.rows(), side_);
    std::vector<double> weights;
    std::vector<GridCell> uneven;
    for (int row = 0; row < down_; ++row)
        for (int column = 0; column < across_; ++column) {
            const Sum sum = sum_of(grid, {column, row});
            weights.push_back(sum.weight), total_ += sum.weight;
            if (!sum.is_even()) uneven.push_back({column, row});
            blocks_.push_back({float(sum.mean()), sum.is_even() ? 0 : std::uint32_t(uneven.size())});
        }
    choice_ = GuidedGrid(weights, across_, down_);
    fine_.resize(uneven.size() * fine_size());
    for (std::size_t i = 0; i < uneven.size(); ++i) fill_fine(grid, uneven[i], &fine_[i * fine_size()]);
}

SkyBlocks::Sum SkyBlocks::sum_of(const SkyGrid& grid, GridCell block) const {
    Sum sum;
    const auto [left, right] = part(block.column, grid.width);
    const auto [top, bottom] = part(block.row, grid.rows());
    for (int r = top; r < bottom; ++r) {
        const double cell = grid.solid_angle(r);
        for (int c = left; c < right; ++c) {
            const auto k = grid.corners(c, r);
            sum.weight += cell * 0.25 * (double(k[0]) + k[1] + k[2] + k[3]);
            sum.square += cell * mean_square(k);
            sum.peak = std::max(sum.peak, double(std::ranges::max(k)));
        }
        sum.solid_angle += cell * (right - left);
    }
    return sum;
}

/// Fills the table of the cells of a block. Cells beyond the edge of the grid have weight 0.
void SkyBlocks::fill_fine(const SkyGrid& grid, GridCell block, std::uint32_t* table) const {
    std::vector<double> weights(std::size_t(side_) * side_);
    const auto [left, right] = part(block.column, grid.width);
    const auto [top, bottom] = part(block.row, grid.rows());
    for (int r = top; r < bottom; ++r)
        for (int c = left; c < right; ++c) weights[std::size_t(r - top) * side_ + (c - left)] = grid.weight(c, r);
    fill_grid_cdf(weights, side_, side_, table);
}

SkyDraw SkyBlocks::sample(const SkyGrid& grid, Vec2f u) const {
    Vec2d rest = with_more_bits(u);
    const GridCell chosen = choice_.choose(rest);
    const Block& block = blocks_[chosen.row * across_ + chosen.column];
    const auto c = part(chosen.column, grid.width), r = part(chosen.row, grid.rows());
    if (block.fine == 0) return {grid.sample_even(c, r, rest), block.weight};
    const GridCell cell = choose_in_grid(&fine_[(block.fine - 1) * fine_size()], side_, side_, rest);
    return grid.sample_in(c[0] + cell.column, r[0] + cell.row, {float(rest.x), float(rest.y)});
}

float SkyBlocks::weight(const SkyGrid& grid, const SkyGrid::Place& at, Vec3f direction) const {
    const Block& block = blocks_[block_of(at.c, at.r)];
    return block.fine == 0 ? block.weight : grid.weight(at, direction);
}

}  // namespace dg
