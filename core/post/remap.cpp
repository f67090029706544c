#include "post/remap.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "math/error.h"
#include "post/remap_tile.h"
#include "post/remap_wide.h"

namespace dg {
namespace {

constexpr int kCell = SourceMap::kCell;
constexpr int kMaxRegion = 16 * kTileWidth * kTileHeight;   // pixels; beyond it a map is torn

/// Displacements and stretches of a tile's pixels by one map.
struct TileMap {
    float dx[kTileHeight][kTileWidth], dy[kTileHeight][kTileWidth];
    float sx[kTileHeight][kTileWidth], sy[kTileHeight][kTileWidth];

    void read(const SourceMap& map, int x0, int y0, bool antialias) {
        CellMap cell;
        for (int v = 0; v < kTileHeight; v += kCell)
            for (int u = 0; u < kTileWidth; u += kCell) {
                const int column = (x0 + u) / kCell, row = (y0 - map.top + v) / kCell;
                if (row < 0 || column >= map.columns || row >= map.rows) continue;
                cell.read(map, column, row);
                put(cell, u, v, antialias);
            }
    }

  private:
    void put(const CellMap& cell, int u, int v, bool antialias) {
        for (int j = 0; j < kCell; ++j) {
            std::copy_n(cell.dx[j], kCell, dx[v + j] + u);
            std::copy_n(cell.dy[j], kCell, dy[v + j] + u);
            for (int i = 0; i < kCell; ++i) {
                float x = 1, y = 1;
                if (antialias) stretches(cell, i, j, x, y);
                sx[v + j][u + i] = x, sy[v + j][u + i] = y;
            }
        }
    }

    /// By differences within the cell, so that no other cell has a say.
    static void stretches(const CellMap& c, int i, int j, float& x, float& y) {
        const int i0 = std::min(i, kCell - 2), j0 = std::min(j, kCell - 2);
        const float xx = 1 + c.dx[j][i0 + 1] - c.dx[j][i0], xy = c.dx[j0 + 1][i] - c.dx[j0][i];
        const float yx = c.dy[j][i0 + 1] - c.dy[j][i0], yy = 1 + c.dy[j0 + 1][i] - c.dy[j0][i];
        x = stretch_of(std::sqrt(xx * xx + xy * xy));
        y = stretch_of(std::sqrt(yx * yx + yy * yy));
    }
};

struct Job {
    const RemapSource& source;
    std::span<const SourceMap> maps;
    std::span<const int> map_of;
    int begin, end;
    RemapFilter filter;
    bool antialias;
    float* out;
    std::atomic<std::int64_t> undefined{0};
};

/// Nearest whole number below, and the rest.
struct Split {
    int whole;
    float rest;
    explicit Split(float d) : whole(int(std::floor(d))), rest(d - float(whole)) {}
};

class Tile {
  public:
    Tile(Job& job, int x0, int y0)
        : job_(job),
          x0_(x0),
          y0_(y0),
          x1_(std::min(x0 + kTileWidth, job.source.width)),
          top_(std::max(y0, job.begin)),
          bottom_(std::min(y0 + kTileHeight, job.end)) {}

    void run() {
        for (int m = 0; m < int(job_.maps.size()); ++m) {
            map_.read(job_.maps[m], x0_, y0_, job_.antialias);
            const bool together = find_region(m);
            for (int y = top_; y < bottom_; ++y) row(y, m, together);
        }
    }

  private:
    bool inside(float x, float y) const {   // false for NaN
        return x >= -0.5f && y >= -0.5f && x <= float(job_.source.width) - 0.5f &&
               y <= float(job_.source.height) - 0.5f;
    }
    bool plain(int u, int v) const { return map_.sx[v][u] == 1 && map_.sy[v][u] == 1; }

    /// The region that plain pixels read; false if it would be absurdly large.
    bool find_region(int m) {
        int left = 1 << 30, right = -left, up = left, down = -left;
        for (int y = top_; y < bottom_; ++y)
            for (int x = x0_; x < x1_; ++x) {
                const float dx = map_.dx[y - y0_][x - x0_], dy = map_.dy[y - y0_][x - x0_];
                if (!plain(x - x0_, y - y0_) || !inside(x + dx, y + dy)) continue;
                const int ix = x + int(std::floor(dx)), iy = y + int(std::floor(dy));
                left = std::min(left, ix), right = std::max(right, ix);
                up = std::min(up, iy), down = std::max(down, iy);
            }
        region_.x0 = left - 1, region_.y0 = up - 1;
        region_.width = std::max(right - left + 4, 0), region_.height = std::max(down - up + 4, 0);
        if (right < left) region_.width = region_.height = 0;
        if (std::int64_t(region_.width) * region_.height > kMaxRegion) return false;
        if (region_.width > 0) fill(m);
        return true;
    }

    void fill(int m) {
        const RemapSource& s = job_.source;
        const std::size_t plane = std::size_t(region_.width) * region_.height;
        region_.values.resize(plane * s.channels);
        for (int j = 0; j < region_.height; ++j) {
            const float* line = source_row(s, region_.y0 + j);
            for (int c = 0; c < s.channels; ++c) {
                if (job_.map_of[c] != m) continue;
                float* to = region_.values.data() + c * plane + std::size_t(j) * region_.width;
                for (int i = 0; i < region_.width; ++i) {
                    const int x = std::clamp(region_.x0 + i, 0, s.width - 1);
                    to[i] = line[std::size_t(x) * s.channels + c];
                }
            }
        }
    }

    void row(int y, int m, bool together) {
        const RemapSource& s = job_.source;
        const int v = y - y0_, count = x1_ - x0_;
        RemapRow places;
        bool simple[kTileWidth];
        for (int u = 0; u < kTileWidth; ++u) {
            const float dx = map_.dx[v][u], dy = map_.dy[v][u];
            simple[u] = u < count && together && plain(u, v) && inside(x0_ + u + dx, y + dy);
            const Split x(simple[u] ? dx : 0), iy(simple[u] ? dy : 0);
            places.tx[u] = x.rest, places.ty[u] = iy.rest;
            places.offset[u] = simple[u] ? (y + iy.whole - 1 - region_.y0) * region_.width +
                                               (x0_ + u + x.whole - 1 - region_.x0)
                                         : 0;
        }
        float* out = job_.out + (std::size_t(y - job_.begin) * s.width + x0_) * s.channels;
        const bool any = std::any_of(simple, simple + count, [](bool b) { return b; });
        for (int c = 0; c < s.channels; ++c) {
            if (job_.map_of[c] != m) continue;
            float values[kTileWidth];
            if (any)
                remap_row(region_.plane(c), region_.width, places, weights_of(job_.filter),
                          (count + 3) / 4 * 4, values);
            for (int u = 0; u < count; ++u)
                out[std::size_t(u) * s.channels + c] = simple[u] ? values[u] : other(u, v, c);
        }
        if (m == 0) count_undefined(v, count);
    }

    /// A pixel that is stretched, far from its neighbours, or outside.
    float other(int u, int v, int c) const {
        const float dx = map_.dx[v][u], dy = map_.dy[v][u];
        if (!inside(x0_ + u + dx, y0_ + v + dy)) return 0;
        const Split x(dx), y(dy);
        return sample_wide(job_.source, c, {x0_ + u + x.whole, x.rest, map_.sx[v][u]},
                           {y0_ + v + y.whole, y.rest, map_.sy[v][u]}, job_.filter);
    }

    void count_undefined(int v, int count) {
        const auto lost = std::count_if(map_.dx[v], map_.dx[v] + count,
                                        [](float d) { return !std::isfinite(d); });
        if (lost) job_.undefined += lost;
    }

    Job& job_;
    int x0_, y0_, x1_, top_, bottom_;
    TileMap map_;
    RemapRegion region_;
};

void check(const RemapSource& s, std::span<const SourceMap> maps, std::span<const int> map_of,
           int begin, int end) {
    if (int(map_of.size()) != s.channels || maps.empty())
        throw input_error("remap", "maps", "one for each channel", std::to_string(maps.size()));
    for (int m : map_of)
        if (m < 0 || m >= int(maps.size()))
            throw input_error("remap", "map of a channel", "one of the maps", std::to_string(m));
    for (const SourceMap& m : maps) {
        m.check();
        if (begin < m.top || end > m.top + m.rows * kCell || s.width > m.columns * kCell)
            throw input_error("remap", "map", "cells for all pixels", "fewer");
    }
}

}  // namespace

const RemapWeights& weights_of(RemapFilter filter) {
    static constexpr RemapWeights cubic{
        {{0, 1, 0, 0}, {-0.5f, 0, 0.5f, 0}, {1, -2.5f, 2, -0.5f}, {-0.5f, 1.5f, -1.5f, 0.5f}}};
    static constexpr RemapWeights linear{{{0, 1, 0, 0}, {0, -1, 1, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}};
    return filter == RemapFilter::cubic ? cubic : linear;
}

RemapResult remap(const RemapSource& source, std::span<const SourceMap> maps,
                  std::span<const int> map_of, int begin, int end, RemapFilter filter,
                  bool antialias) {
    check(source, maps, map_of, begin, end);
    RemapResult result;
    result.values.resize(std::size_t(end - begin) * source.width * source.channels);
    Job job{source, maps, map_of, begin, end, filter, antialias, result.values.data()};
    const int columns = (source.width + kTileWidth - 1) / kTileWidth;
    const int first = begin / kTileHeight, last = (end + kTileHeight - 1) / kTileHeight;
    oneapi::tbb::parallel_for(first * columns, last * columns, [&](int k) {
        Tile(job, k % columns * kTileWidth, k / columns * kTileHeight).run();
    });
    result.undefined = job.undefined;
    return result;
}

std::vector<std::uint32_t> remap_nearest(std::span<const std::uint32_t> values, int width,
                                         int height, int first, const SourceMap& map, int begin,
                                         int end) {
    std::vector<std::uint32_t> out(std::size_t(end - begin) * width);
    const int rows = int(values.size() / width);
    map.check();
    oneapi::tbb::parallel_for(begin / kCell, (end + kCell - 1) / kCell, [&](int k) {
        CellMap cell;
        for (int column = 0; column * kCell < width; ++column) {
            cell.read(map, column, k - map.top / kCell);
            for (int y = std::max(k * kCell, begin); y < std::min((k + 1) * kCell, end); ++y)
                for (int x = column * kCell; x < std::min((column + 1) * kCell, width); ++x) {
                    const int v = y % kCell, u = x % kCell;
                    const float sx = x + std::floor(cell.dx[v][u] + 0.5f);
                    const float sy = y + std::floor(cell.dy[v][u] + 0.5f);
                    if (!(sx >= 0 && sy >= 0 && sx < width && sy < height)) continue;
                    const int line = int(sy) - first;
                    if (line < 0 || line >= rows)
                        throw input_error("remap", "rows", "those that the map reads", "fewer");
                    out[std::size_t(y - begin) * width + x] =
                        values[std::size_t(line) * width + int(sx)];
                }
        }
    });
    return out;
}

}  // namespace dg
