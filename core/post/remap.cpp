#include "post/remap.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "math/error.h"
#include "post/interleave.h"
#include "post/remap_tile.h"
#include "post/remap_wide.h"
#include "post/tile_map.h"

namespace dg {
namespace {

constexpr int kCell = SourceMap::kCell;
constexpr int kMaxRegion =
    16 * kTileWidth * kTileHeight;  // pixels; a larger region means a torn map

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

/// Floor and fraction.
struct Split {
    int whole;
    float rest;
    explicit Split(float d) : whole(int(std::floor(d))), rest(d - float(whole)) {}
};

/// Working memory, reused for all tiles.
class Tile {
  public:
    explicit Tile(Job& job)
        : job_(job),
          maps_(job.maps.size()),
          values_(std::size_t(job.source.channels) * kPlane) {}

    void fill(int x0, int y0) {
        x0_ = x0, y0_ = y0;
        count_ = std::min(kTileWidth, job_.source.width - x0);
        top_ = std::max(y0, job_.begin), bottom_ = std::min(y0 + kTileHeight, job_.end);
        for (std::size_t m = 0; m < maps_.size(); ++m)
            maps_[m].read(job_.maps[m], x0, y0, job_.antialias);
        const bool together = find_region();
        for (int y = top_; y < bottom_; ++y) {
            for (std::size_t m = 0; m < maps_.size(); ++m) row(y, int(m), together);
            write(y);
            count_undefined(y);
        }
    }

  private:
    static constexpr std::size_t kPlane = kTileWidth;

    RemapPlaces places(int y, int m) const {
        const TileMap& map = maps_[m];
        const int v = y - y0_;
        return {map.dx[v], map.dy[v], map.stretched ? map.sx[v] : nullptr, map.sy[v], x0_,
                y, count_, job_.source.width, job_.source.height, &region_};
    }
    bool inside(float x, float y) const {  // false for NaN
        return (x >= -0.5f) & (y >= -0.5f) & (x <= float(job_.source.width) - 0.5f) &
               (y <= float(job_.source.height) - 0.5f);
    }

    /// Computes the source region that the tile's pixels read through any map; false if it is too
    /// large.
    bool find_region() {
        RemapBounds b;
        for (std::size_t m = 0; m < maps_.size(); ++m)
            for (int y = top_; y < bottom_; ++y) remap_bounds(places(y, int(m)), b);
        region_ = RemapRegion{0, 0, 0, 0, std::move(region_.values)};
        if (!(b.left <= b.right && b.up <= b.down)) return false;  // no pixel is inside the source
        // A pixel of margin on either side for rounding.
        region_.x0 = int(std::floor(b.left)) - 2, region_.y0 = int(std::floor(b.up)) - 2;
        region_.width = int(std::floor(b.right)) + 4 - region_.x0;
        region_.height = int(std::floor(b.down)) + 4 - region_.y0;
        if (std::int64_t(region_.width) * region_.height > kMaxRegion) return false;
        read_region();
        return true;
    }

    void read_region() {
        const RemapSource& s = job_.source;
        RemapRegion& r = region_;
        r.values.resize(r.size() * s.channels);
        const int left = std::clamp(-r.x0, 0, r.width),
                  right = std::clamp(s.width - r.x0, left, r.width);
        for (int j = 0; j < r.height; ++j) {
            float* to = r.values.data() + std::size_t(j) * r.width;
            const float* line =
                source_row(s, r.y0 + j) + std::size_t(r.x0 + left) * s.channels;
            split_channels(line, right - left, s.channels, to + left, r.size());
            for (int c = 0; c < s.channels; ++c, to += r.size()) {
                std::fill(to, to + left, to[left]);
                std::fill(to + right, to + r.width, to[right - 1]);
            }
        }
    }

    void row(int y, int m, bool together) {
        RemapRow row;
        int filled = 0;
        if (together) filled = remap_places(places(y, m), row);
        channels_.clear();
        for (int c = 0; c < job_.source.channels; ++c)
            if (job_.map_of[c] == m)
                channels_.push_back({region_.plane(c), values_.data() + c * kPlane});
        if (filled)
            remap_row(channels_, region_.width, row, weights_of(job_.filter));
        for (int u = 0; filled < count_ && u < count_; ++u) {
            if (filled && row.here[u]) continue;
            for (int c = 0; c < job_.source.channels; ++c)
                if (job_.map_of[c] == m) values_[c * kPlane + u] = other(u, y - y0_, c);
        }
    }

    /// Pixel that is stretched, outside of the region, or undefined.
    float other(int u, int v, int c) const {
        const TileMap& map = maps_[job_.map_of[c]];
        const float dx = map.dx[v][u], dy = map.dy[v][u];
        if (!inside(x0_ + u + dx, y0_ + v + dy)) return 0;
        const Split x(dx), y(dy);
        const float sx = map.stretched ? map.sx[v][u] : 1,
                    sy = map.stretched ? map.sy[v][u] : 1;
        return sample_wide(job_.source, c, {x0_ + u + x.whole, x.rest, sx},
                           {y0_ + v + y.whole, y.rest, sy}, job_.filter);
    }

    void write(int y) {
        const RemapSource& s = job_.source;
        float* to = job_.out + (std::size_t(y - job_.begin) * s.width + x0_) * s.channels;
        join_channels(values_.data(), kPlane, count_, s.channels, to);
    }

    void count_undefined(int y) {
        const float* dx = maps_[0].dx[y - y0_];
        const auto lost =
            std::count_if(dx, dx + count_, [](float d) { return !std::isfinite(d); });
        if (lost) job_.undefined += lost;
    }

    Job& job_;
    std::vector<TileMap> maps_;
    std::vector<float> values_;  // of a row, planar
    std::vector<RemapChannel> channels_;
    RemapRegion region_;
    int x0_ = 0, y0_ = 0, count_ = 0, top_ = 0, bottom_ = 0;
};

/// Checks that the map has cells for rows [begin, end) of an image of the given width.
void check(const SourceMap& m, int width, int begin, int end) {
    m.check();
    if (!(0 <= begin && begin <= end))
        throw input_error("remap", "rows", "rows of the picture",
                          std::to_string(begin) + " to " + std::to_string(end));
    if (begin < m.top || end > m.top + m.rows * kCell || width < 1 || width > m.columns * kCell)
        throw input_error("remap", "map", "cells for all pixels", "fewer");
}

void check(const RemapSource& s, std::span<const SourceMap> maps,
           std::span<const int> map_of, int begin, int end) {
    if (s.channels < 1 || s.height < 1 || s.first < 0)
        throw input_error("remap", "picture", "rows and channels",
                          std::to_string(s.height) + " and " + std::to_string(s.channels));
    if (int(map_of.size()) != s.channels || maps.empty())
        throw input_error("remap", "maps", "one for each channel",
                          std::to_string(maps.size()));
    for (int m : map_of)
        if (m < 0 || m >= int(maps.size()))
            throw input_error("remap", "map of a channel", "the index of a map",
                              std::to_string(m));
    for (const SourceMap& m : maps) check(m, s.width, begin, end);
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
    const oneapi::tbb::blocked_range<int> tiles(first * columns, last * columns);
    oneapi::tbb::parallel_for(tiles, [&](const auto& part) {
        Tile tile(job);
        for (int k = part.begin(); k < part.end(); ++k)
            tile.fill(k % columns * kTileWidth, k / columns * kTileHeight);
    });
    result.undefined = job.undefined;
    return result;
}

std::vector<std::uint32_t> remap_nearest(std::span<const std::uint32_t> values, int width,
                                         int height, int first, const SourceMap& map,
                                         int begin, int end) {
    check(map, width, begin, end);
    std::vector<std::uint32_t> out(std::size_t(end - begin) * width);
    const int rows = int(values.size() / width);
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
                        throw input_error("remap", "rows", "all rows that the map reads",
                                          "fewer");
                    out[std::size_t(y - begin) * width + x] =
                        values[std::size_t(line) * width + int(sx)];
                }
        }
    });
    return out;
}

}  // namespace dg
