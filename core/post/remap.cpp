#include "post/remap.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "math/error.h"
#include "math/vec.h"
#include "post/remap_tile.h"
#include "post/remap_wide.h"

namespace dg {
namespace {

constexpr int kCell = SourceMap::kCell;
constexpr int kMaxRegion =
    16 * kTileWidth * kTileHeight;  // pixels; beyond it a map is torn

/// Displacements and stretches of a tile's pixels by one map.
struct TileMap {
    float dx[kTileHeight][kTileWidth], dy[kTileHeight][kTileWidth];
    float sx[kTileHeight][kTileWidth], sy[kTileHeight][kTileWidth];
    bool stretched = false;  // else sx and sy are 1, and not set

    void read(const SourceMap& map, int x0, int y0, bool antialias) {
        CellMap cell;
        stretched = false;
        for (int v = 0; v < kTileHeight; v += kCell)
            for (int u = 0; u < kTileWidth; u += kCell) {
                const int column = (x0 + u) / kCell, row = (y0 - map.top + v) / kCell;
                if (row < 0 || y0 + v < map.top || column >= map.columns ||
                    row >= map.rows) {
                    blank(u, v);
                    continue;
                }
                cell.read(map, column, row);
                for (int j = 0; j < kCell; ++j) {
                    std::copy_n(cell.dx[j], kCell, dx[v + j] + u);
                    std::copy_n(cell.dy[j], kCell, dy[v + j] + u);
                }
                stretched = stretched || (antialias && shrinks(cell));
            }
        if (stretched) read_stretches();
    }

  private:
    void blank(int u, int v) {
        for (int j = 0; j < kCell; ++j) {
            std::fill_n(dx[v + j] + u, kCell, NAN);
            std::fill_n(dy[v + j] + u, kCell, NAN);
        }
    }

    /// Squares of steps in the source, across and down, at one pixel of a cell whose rows
    /// are `stride` apart: by differences within the cell, so that no other cell has a
    /// say.
    static Vec2f steps(const float* x, const float* y, int stride, int i, int j) {
        const int i0 = std::min(i, kCell - 2), j0 = std::min(j, kCell - 2);
        const int a = j * stride + i0, b = j0 * stride + i;
        const float xx = 1 + x[a + 1] - x[a], xy = x[b + stride] - x[b];
        const float yx = y[a + 1] - y[a], yy = 1 + y[b + stride] - y[b];
        return {xx * xx + xy * xy, yx * yx + yy * yy};
    }

    static bool shrinks(const CellMap& c) {
        float most = 0;
        for (int j = 0; j < kCell; ++j)
            for (int i = 0; i < kCell; ++i) {
                const Vec2f s = steps(c.dx[0], c.dy[0], kCell, i, j);
                most = std::max(most, std::max(s.x, s.y));  // NaN does not count
            }
        return stretch_of(std::sqrt(most)) > 1;
    }

    void read_stretches() {
        for (int v = 0; v < kTileHeight; ++v)
            for (int u = 0; u < kTileWidth; ++u) {
                const int v0 = v / kCell * kCell, u0 = u / kCell * kCell;
                const Vec2f s =
                    steps(dx[v0] + u0, dy[v0] + u0, kTileWidth, u - u0, v - v0);
                sx[v][u] = stretch_of(std::sqrt(s.x)),
                sy[v][u] = stretch_of(std::sqrt(s.y));
            }
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
    bool inside(float x, float y) const {  // false for NaN
        return (x >= -0.5f) & (y >= -0.5f) & (x <= float(job_.source.width) - 0.5f) &
               (y <= float(job_.source.height) - 0.5f);
    }
    float stretch_x(int u, int v) const { return map_.stretched ? map_.sx[v][u] : 1; }
    float stretch_y(int u, int v) const { return map_.stretched ? map_.sy[v][u] : 1; }

    /// The region that pixels within the source read; false if it would be absurdly
    /// large.
    bool find_region(int m) {
        float left = INFINITY, right = -left, up = left, down = -left;
        for (int y = top_; y < bottom_; ++y) {
            const float *dx = map_.dx[y - y0_], *dy = map_.dy[y - y0_];
            for (int u = 0; u < x1_ - x0_; ++u) {
                const float x = float(x0_ + u) + dx[u], line = float(y) + dy[u];
                const bool in = inside(x, line);
                left = in && x < left ? x : left, right = in && x > right ? x : right;
                up = in && line < up ? line : up, down = in && line > down ? line : down;
            }
        }
        region_ = RemapRegion{0, 0, 0, 0, std::move(region_.values)};
        if (!(left <= right && up <= down)) return false;  // nothing is there
        // A pixel more on either side: the sum of a place is rounded.
        region_.x0 = int(std::floor(left)) - 2, region_.y0 = int(std::floor(up)) - 2;
        region_.width = int(std::floor(right)) + 4 - region_.x0;
        region_.height = int(std::floor(down)) + 4 - region_.y0;
        if (std::int64_t(region_.width) * region_.height > kMaxRegion) return false;
        fill(m);
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
                float* to =
                    region_.values.data() + c * plane + std::size_t(j) * region_.width;
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
        std::fill_n(places.here, kTileWidth, 0);
        if (together)
            remap_places({map_.dx[v], map_.dy[v], map_.stretched ? map_.sx[v] : nullptr,
                          map_.sy[v], x0_, y, s.width, s.height, &region_},
                         places);
        std::fill(places.offset + count, places.offset + kTileWidth, 0);
        const auto filled = std::count(places.here, places.here + count, 1);
        float* out =
            job_.out + (std::size_t(y - job_.begin) * s.width + x0_) * s.channels;
        for (int c = 0; c < s.channels; ++c) {
            if (job_.map_of[c] != m) continue;
            float values[kTileWidth] = {};
            if (filled)
                remap_row(region_.plane(c), region_.width, places,
                          weights_of(job_.filter), (count + 3) / 4 * 4, values);
            for (int u = 0; u < count; ++u)
                out[std::size_t(u) * s.channels + c] = values[u];
            for (int u = 0; filled < count && u < count; ++u)
                if (!places.here[u])
                    out[std::size_t(u) * s.channels + c] = other(u, v, c);
        }
        if (m == 0) count_undefined(v, count);
    }

    /// A pixel that is stretched, far from its neighbours, or outside.
    float other(int u, int v, int c) const {
        const float dx = map_.dx[v][u], dy = map_.dy[v][u];
        if (!inside(x0_ + u + dx, y0_ + v + dy)) return 0;
        const Split x(dx), y(dy);
        return sample_wide(job_.source, c, {x0_ + u + x.whole, x.rest, stretch_x(u, v)},
                           {y0_ + v + y.whole, y.rest, stretch_y(u, v)}, job_.filter);
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

void check(const RemapSource& s, std::span<const SourceMap> maps,
           std::span<const int> map_of, int begin, int end) {
    if (int(map_of.size()) != s.channels || maps.empty())
        throw input_error("remap", "maps", "one for each channel",
                          std::to_string(maps.size()));
    for (int m : map_of)
        if (m < 0 || m >= int(maps.size()))
            throw input_error("remap", "map of a channel", "one of the maps",
                              std::to_string(m));
    for (const SourceMap& m : maps) {
        m.check();
        if (begin < m.top || end > m.top + m.rows * kCell || s.width > m.columns * kCell)
            throw input_error("remap", "map", "cells for all pixels", "fewer");
    }
}

}  // namespace

const RemapWeights& weights_of(RemapFilter filter) {
    static constexpr RemapWeights cubic{{{0, 1, 0, 0},
                                         {-0.5f, 0, 0.5f, 0},
                                         {1, -2.5f, 2, -0.5f},
                                         {-0.5f, 1.5f, -1.5f, 0.5f}}};
    static constexpr RemapWeights linear{
        {{0, 1, 0, 0}, {0, -1, 1, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}};
    return filter == RemapFilter::cubic ? cubic : linear;
}

RemapResult remap(const RemapSource& source, std::span<const SourceMap> maps,
                  std::span<const int> map_of, int begin, int end, RemapFilter filter,
                  bool antialias) {
    check(source, maps, map_of, begin, end);
    RemapResult result;
    result.size = std::size_t(end - begin) * source.width * source.channels;
    result.values = std::make_unique_for_overwrite<float[]>(result.size);
    Job job{source, maps, map_of, begin, end, filter, antialias, result.values.get()};
    const int columns = (source.width + kTileWidth - 1) / kTileWidth;
    const int first = begin / kTileHeight, last = (end + kTileHeight - 1) / kTileHeight;
    oneapi::tbb::parallel_for(first * columns, last * columns, [&](int k) {
        Tile(job, k % columns * kTileWidth, k / columns * kTileHeight).run();
    });
    result.undefined = job.undefined;
    return result;
}

std::vector<std::uint32_t> remap_nearest(std::span<const std::uint32_t> values, int width,
                                         int height, int first, const SourceMap& map,
                                         int begin, int end) {
    std::vector<std::uint32_t> out(std::size_t(end - begin) * width);
    const int rows = int(values.size() / width);
    map.check();
    oneapi::tbb::parallel_for(begin / kCell, (end + kCell - 1) / kCell, [&](int k) {
        CellMap cell;
        for (int column = 0; column * kCell < width; ++column) {
            cell.read(map, column, k - map.top / kCell);
            for (int y = std::max(k * kCell, begin); y < std::min((k + 1) * kCell, end);
                 ++y)
                for (int x = column * kCell; x < std::min((column + 1) * kCell, width);
                     ++x) {
                    const int v = y % kCell, u = x % kCell;
                    const float sx = x + std::floor(cell.dx[v][u] + 0.5f);
                    const float sy = y + std::floor(cell.dy[v][u] + 0.5f);
                    if (!(sx >= 0 && sy >= 0 && sx < width && sy < height)) continue;
                    const int line = int(sy) - first;
                    if (line < 0 || line >= rows)
                        throw input_error("remap", "rows", "those that the map reads",
                                          "fewer");
                    out[std::size_t(y - begin) * width + x] =
                        values[std::size_t(line) * width + int(sx)];
                }
        }
    });
    return out;
}

}  // namespace dg
