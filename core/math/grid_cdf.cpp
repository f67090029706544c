#include "math/grid_cdf.h"

#include <cmath>
#include <numeric>
#include <vector>

namespace dg {

namespace {

void fill_cdf(std::span<const double> weights, std::uint32_t* begins) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    double before = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        begins[i] = sum > 0 ? std::uint32_t(std::min(std::round(before / sum * 0x1p32), 0x1p32 - 1)) : 0;
        before += weights[i];
    }
}

/// guides[j]: the entry at j / count; guides[count]: the last entry.
void fill_guides(const std::uint32_t* begins, int count, std::uint16_t* guides) {
    int entry = 0;
    for (int j = 0; j < count; ++j) {
        const std::uint64_t at = ((std::uint64_t(j) << 32) + count - 1) / count;
        while (entry + 1 < count && begins[entry + 1] <= at) ++entry;
        guides[j] = std::uint16_t(entry);
    }
    guides[count] = std::uint16_t(count - 1);
}

}  // namespace

GuidedGrid::GuidedGrid(std::span<const double> weights, int across, int down)
    : across_(across), down_(down), table_(grid_cdf_size(across, down)),
      guides_(grid_cdf_size(across, down) + down + 1) {
    fill_grid_cdf(weights, across, down, table_.data());
    fill_guides(table_.data(), down, guides_.data());
    for (int row = 0; row < down; ++row) {
        const std::size_t skipped = std::size_t(down) + std::size_t(row) * across;
        fill_guides(table_.data() + skipped, across, guides_.data() + skipped + row + 1);
    }
}

void fill_grid_cdf(std::span<const double> weights, int across, int down, std::uint32_t* table) {
    std::vector<double> rows(down);
    for (int row = 0; row < down; ++row) {
        const auto own = weights.subspan(std::size_t(row) * across, across);
        rows[row] = std::accumulate(own.begin(), own.end(), 0.0);
        fill_cdf(own, table + down + std::size_t(row) * across);
    }
    fill_cdf(rows, table);
}

}  // namespace dg
