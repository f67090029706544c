// film_layout.h -- the size of a film and the layers that it keeps.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace dg {

/// Layers of a film, in the order of the table in layers.h.
enum class Layer : std::uint8_t {
    sums, aovs, splats, flare, halves, coverage, catchers, bands, channels, channel_splats, catcher_channels, objects
};
inline constexpr std::size_t kLayerCount = std::size_t(Layer::objects) + 1;

/// Layers that a film is asked to keep, each with a count: 1, or the number of bands or channels.
class LayerCounts {
  public:
    struct Asked {
        constexpr Asked(Layer which, int times = 1) : layer(which), count(times) {}
        Layer layer;
        int count;
    };
    constexpr LayerCounts() = default;
    constexpr LayerCounts(std::initializer_list<Asked> all) {
        for (const Asked& one : all) (*this)[one.layer] = one.count;
    }
    /// Count of a layer; 0 also for a layer of another table.
    constexpr int operator[](Layer layer) const {
        return std::size_t(layer) < kLayerCount ? counts_[std::size_t(layer)] : 0;
    }
    constexpr int& operator[](Layer layer) { return counts_[std::size_t(layer)]; }
    friend bool operator==(const LayerCounts&, const LayerCounts&) = default;

  private:
    std::array<int, kLayerCount> counts_{};
};

struct FilmLayout {
    int width = 0, height = 0;       // size of the stored region, px
    int offset_x = 0, offset_y = 0;  // upper left pixel of the region in the full frame
    LayerCounts layers{};            // layers in addition to Layer::sums, which every film has
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    friend bool operator==(const FilmLayout&, const FilmLayout&) = default;
};

/// Pixels [x0, x1) x [y0, y1) of the full frame.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

}  // namespace dg
