// spread.h -- splatting of pixels with occlusion by layers.
//
// Each pixel splats its light and its coverage of 1, by a kernel (disc, streak), into the layer of
// its depth. Layers are composited front to back: each takes the fraction of the lens (or of the
// exposure) that it covers, up to the remainder. So the parts of a surface sum to 1 regardless of
// the number of layers, nearer layers occlude, and the final remainder shows the estimate of hidden
// surfaces (hidden.h). With a single layer and kernel, the result is a convolution.
//
// Sources: order of layers after Potmesil and Chakravarty 1981 (splatting instead of gathering);
// running sums after Kosloff, Tao and Barsky 2009, Depth of field postprocessing for layered scenes
// using constant-time rectangle spreading.
#pragma once
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace dg {

inline constexpr int kSpreadTile = 256, kSpreadBlock = 32, kSpreadColours = 4;

/// Image of kSpreadColours values per pixel, row-major.
struct SpreadPicture {
    int width = 0, height = 0;
    std::span<const float> values;
    std::span<const float> covers = {};   // coverage per pixel; empty: 1
    float cover(std::size_t pixel) const { return covers.empty() ? 1.f : covers[pixel]; }
    const float* at(std::size_t pixel) const { return values.data() + kSpreadColours * pixel; }
    bool finite(std::size_t pixel) const {
        const float* v = at(pixel);
        return std::all_of(v, v + kSpreadColours, [](float c) { return std::isfinite(c); });
    }
};

/// Light, and its coverage of a pixel.
struct SpreadLight {
    double colour[kSpreadColours] = {};
    double cover = 0;

    static SpreadLight of(const float* colour, float cover) {
        SpreadLight l{.cover = cover};
        std::copy(colour, colour + kSpreadColours, l.colour);
        return l;
    }
    void add(const SpreadLight& l, double weight) {
        for (int c = 0; c < kSpreadColours; ++c) colour[c] += weight * l.colour[c];
        cover += weight * l.cover;
    }
};

/// A layer of a tile, in image coordinates.
struct SpreadLayer {
    int x0, y0, x1, y1;   // ends exclusive
    std::vector<SpreadLight> light = std::vector<SpreadLight>(kSpreadTile * kSpreadTile);

    SpreadLight* row(int y) { return light.data() + std::size_t(y - y0) * kSpreadTile; }
    /// Converts changes along rows to light by running sums.
    void run_sums() {
        for (int y = y0; y < y1; ++y) {
            SpreadLight* const values = row(y);
            for (int x = 1; x < x1 - x0; ++x) values[x].add(values[x - 1], 1);
        }
    }
};

/// Largest reach per block of pixels, to skip blocks that cannot reach a tile.
template <typename Kernel>
class SpreadBlocks {
  public:
    SpreadBlocks(const Kernel& kernel, const SpreadPicture& picture)
        : across_((picture.width + kSpreadBlock - 1) / kSpreadBlock),
          reach_(std::size_t(across_) * ((picture.height + kSpreadBlock - 1) / kSpreadBlock), -1.f) {
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                float& reach = reach_[std::size_t(y / kSpreadBlock) * across_ + x / kSpreadBlock];
                const std::size_t i = std::size_t(y) * picture.width + x;
                if (picture.cover(i) > 0 && kernel.takes_part(i)) reach = std::max(reach, kernel.reach(i));
            }
    }
    float reach(int block_x, int block_y) const { return reach_[std::size_t(block_y) * across_ + block_x]; }

  private:
    int across_;
    std::vector<float> reach_;
};

/// Image, or the hidden surfaces behind it, with the kernels of its pixels.
template <typename Kernel>
struct SpreadSource {
    SpreadPicture picture;
    const Kernel& kernel;
    SpreadBlocks<Kernel> blocks{kernel, picture};
};

/// Splats all light that reaches a tile into the layers returned by `layer(number)`. A kernel
/// provides, per pixel: takes_part, reach (px), layer (a number; larger is nearer), and spread.
template <typename Source, typename Layer>
void spread_into(const Source& from, const SpreadLayer& tile, const Layer& layer) {
    const auto away = [](int begin, int end, int tile_begin, int tile_end) {
        return float(std::max({tile_begin - end, begin - tile_end, -1}) + 1);
    };
    const int width = from.picture.width, height = from.picture.height;
    const auto spread_pixel = [&](int x, int y) {
        const std::size_t i = std::size_t(y) * width + x;
        const float cover = from.picture.cover(i);
        if (!(cover > 0) || !from.kernel.takes_part(i) || !from.picture.finite(i)) return;
        const float far = std::max(away(x, x + 1, tile.x0, tile.x1), away(y, y + 1, tile.y0, tile.y1));
        if (from.kernel.reach(i) < far) return;
        const SpreadLight light = SpreadLight::of(from.picture.at(i), cover);
        from.kernel.spread(i, x, y, light, layer(from.kernel.layer(i)));
    };
    for (int y0 = 0; y0 < height; y0 += kSpreadBlock)
        for (int x0 = 0; x0 < width; x0 += kSpreadBlock) {
            const int x1 = std::min(x0 + kSpreadBlock, width), y1 = std::min(y0 + kSpreadBlock, height);
            const float far = std::max(away(x0, x1, tile.x0, tile.x1), away(y0, y1, tile.y0, tile.y1));
            if (from.blocks.reach(x0 / kSpreadBlock, y0 / kSpreadBlock) < far) continue;
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x) spread_pixel(x, y);
        }
}

/// Front-to-back compositing of a pixel.
class SpreadShares {
  public:
    void take(const SpreadLight& l) {
        if (l.cover < 1e-6) return;   // running sums leave a residue of about 1e-12
        const double share = std::min(left_, l.cover);
        sum_.add(l, share / l.cover);
        left_ -= share;
    }
    bool full() const { return left_ < 1e-9; }
    bool any() const { return left_ < 1 - 1e-6; }
    void put(float* out) const {
        const double scale = 1 / (1 - left_);
        for (int c = 0; c < kSpreadColours; ++c) out[c] = float(sum_.colour[c] * scale);
    }

  private:
    SpreadLight sum_;
    double left_ = 1;
};

/// Layers of a tile, created on demand.
class SpreadTile {
  public:
    SpreadTile(int x0, int y0, int x1, int y1) : behind{x0, y0, x1, y1} {}

    SpreadLayer& layer(int number) {
        if (last_ && number == last_number_) return *last_;
        auto found = layers_.find(number);
        if (found == layers_.end())
            found = layers_.emplace(number, SpreadLayer{behind.x0, behind.y0, behind.x1, behind.y1}).first;
        last_ = &found->second, last_number_ = number;
        return *last_;
    }
    void run_sums() {
        for (auto& [number, layer] : layers_) layer.run_sums();
        behind.run_sums();
    }
    SpreadShares shares(int x, int y) {
        SpreadShares shares;
        for (auto& [number, layer] : layers_) {
            if (shares.full()) return shares;
            shares.take(layer.row(y)[x - behind.x0]);
        }
        if (!shares.full()) shares.take(behind.row(y)[x - behind.x0]);
        return shares;
    }

    SpreadLayer behind;   // hidden surfaces

  private:
    std::map<int, SpreadLayer, std::greater<>> layers_;   // nearest first
    SpreadLayer* last_ = nullptr;
    int last_number_ = 0;
};

/// Range of rows, end exclusive.
struct SpreadRows {
    int begin, end;
};

/// Composites the rows of the splatted image. All sources have the size of the image: the visible
/// ones, and the hidden surfaces. Non-finite pixels emit no light and keep their value, as do
/// pixels that no light reaches. Bitwise equal for any number of threads.
template <typename Kernel>
std::vector<float> spread(const SpreadPicture& picture, std::span<const SpreadSource<Kernel>> seen,
                          const SpreadSource<Kernel>& hidden, SpreadRows rows) {
    const std::size_t first = std::size_t(rows.begin) * picture.width * kSpreadColours;
    const std::size_t count = std::size_t(rows.end - rows.begin) * picture.width * kSpreadColours;
    std::vector<float> out(picture.values.data() + first, picture.values.data() + first + count);
    const int across = (picture.width + kSpreadTile - 1) / kSpreadTile;
    const int down = (rows.end - rows.begin + kSpreadTile - 1) / kSpreadTile;
    oneapi::tbb::parallel_for(0, across * down, [&](int number) {
        const int x0 = number % across * kSpreadTile, y0 = rows.begin + number / across * kSpreadTile;
        const int x1 = std::min(x0 + kSpreadTile, picture.width), y1 = std::min(y0 + kSpreadTile, rows.end);
        SpreadTile tile(x0, y0, x1, y1);
        for (const SpreadSource<Kernel>& source : seen)
            spread_into(source, tile.behind, [&](int layer) -> SpreadLayer& { return tile.layer(layer); });
        spread_into(hidden, tile.behind, [&](int) -> SpreadLayer& { return tile.behind; });
        if (Kernel::kRunningSums) tile.run_sums();
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const std::size_t i = std::size_t(y) * picture.width + x;
                if (!picture.finite(i)) continue;
                const SpreadShares shares = tile.shares(x, y);
                if (shares.any()) shares.put(out.data() + kSpreadColours * i - first);
            }
    });
    return out;
}

}  // namespace dg
