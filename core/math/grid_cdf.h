// grid_cdf.h -- a choice in a grid of weights by inverse CDFs, of rows and then of columns. Samples keep the
// stratification of their random numbers. CDFs are fixed-point numbers of 32 bits: 4 bytes an entry, and far more
// precise near 1 than floats, and the choice leaves more than 24 bits for a place in the entry (Distribution2D does
// not). Source of guide tables: Chen and Asau 1974; Devroye 1986, II.2.4 and III.2.4.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "math/hash.h"
#include "math/vec.h"

namespace dg {

/// Extends two random numbers to 53 bits, by a hash of both. A choice uses up bits: after a choice among a million
/// entries, the 24 bits of a float would leave too few to choose within the entry.
inline Vec2d with_more_bits(Vec2f u) {
    constexpr std::uint64_t kMost = (1 << 24) - 1;
    const std::uint64_t x = std::min(std::uint64_t(u.x * 0x1p24f), kMost),
                        y = std::min(std::uint64_t(u.y * 0x1p24f), kMost);
    const std::uint64_t more = hash64(x << 24 | y);
    const auto all = [](std::uint64_t high, std::uint32_t low) {
        return double(high << 29 | low >> 3) * 0x1p-53;
    };
    return {all(x, std::uint32_t(more >> 32)), all(y, std::uint32_t(more))};
}

/// A number in [0, 1) in units of 2^-32. The last unit is left out: an entry that begins there is empty.
inline double in_units(double u) {
    return std::min(u * 0x1p32, 0x1p32 - 2);
}

/// Chooses one of the entries [first, last] of a CDF, where entry i begins at begins[i], in units of 2^-32, and the last
/// of all `count` entries ends at 1. Replaces u by a number that is uniform in [0, 1) within the entry.
inline int choose_by_cdf(const std::uint32_t* begins, int count, int first, int last, double& u) {
    const double x = in_units(u);
    const auto whole = std::uint32_t(x);
    for (int left = last - first + 1; left > 1;) {
        const int half = left / 2;
        first = begins[first + half] <= whole ? first + half : first;
        left -= half;
    }
    const double begin = begins[first], end = first + 1 < count ? begins[first + 1] : 0x1p32;
    u = std::min((x - begin) / (end - begin), 0x1.fffffffffffffp-1);
    return first;
}

struct GridCell {
    int column, row;
};

/// A small grid in a table of grid_cdf_size() entries: the CDF of the rows, then the CDF of the entries of each row.
constexpr std::size_t grid_cdf_size(int across, int down) {
    return std::size_t(down) * (across + 1);
}
/// Fills the table of `across` x `down` weights, row by row. Weights are finite and >= 0, and their sum is finite; the
/// table of a sum of 0 must not be used. Entries of weight 0 are never chosen, nor those below 2^-32 of their row.
void fill_grid_cdf(std::span<const double> weights, int across, int down, std::uint32_t* table);
/// Chooses an entry by weight. Replaces u by numbers that are uniform in [0, 1)^2 within the entry.
inline GridCell choose_in_grid(const std::uint32_t* table, int across, int down, Vec2d& u) {
    const int row = choose_by_cdf(table, down, 0, down - 1, u.y);
    return {choose_by_cdf(table + down + std::size_t(row) * across, across, 0, across - 1, u.x), row};
}

/// A large grid, with guides that narrow each search to a few entries.
class GuidedGrid {
  public:
    GuidedGrid() = default;
    /// Arguments like fill_grid_cdf(). `across` and `down` are at most 65535.
    GuidedGrid(std::span<const double> weights, int across, int down);
    /// Like choose_in_grid().
    GridCell choose(Vec2d& u) const {
        const int row = choose_guided(table_.data(), guides_.data(), down_, u.y);
        const std::size_t skipped = std::size_t(down_) + std::size_t(row) * across_;
        return {choose_guided(table_.data() + skipped, guides_.data() + skipped + row + 1, across_, u.x), row};
    }
    std::size_t bytes() const { return bytes(across_, down_); }
    static std::size_t bytes(int across, int down) {
        return grid_cdf_size(across, down) * (sizeof(std::uint32_t) + sizeof(std::uint16_t)) +
               (std::size_t(down) + 1) * sizeof(std::uint16_t);
    }

  private:
    static int choose_guided(const std::uint32_t* begins, const std::uint16_t* guides, int count, double& u) {
        const auto j = int(std::uint64_t(in_units(u)) * std::uint32_t(count) >> 32);
        return choose_by_cdf(begins, count, guides[j], guides[j + 1], u);
    }

    int across_ = 0, down_ = 0;
    std::vector<std::uint32_t> table_;
    std::vector<std::uint16_t> guides_;   // for each CDF, one more than its entries: the entry at j / count
};

}  // namespace dg
