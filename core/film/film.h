// film.h -- linear sums per pixel. Every sum is exact (fixed point, 128 bits): order of samples, number of threads, and
// splits and merges of a frame change no bit. layers.h lists the layers of sums.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "film/camera_light.h"
#include "film/film_layout.h"
#include "film/layer_stores.h"
#include "film/layers.h"
#include "math/vec.h"
#include "spectrum/responses.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// A sample that was dropped because it was not finite or too large.
struct BadSample {
    int x, y;   // px, full frame
    std::uint32_t sample;
};

/// Coverage of pixels by groups of objects. The groups of a pixel are sorted by the magnitude of their share, largest
/// first.
struct Ranked {
    std::vector<std::uint32_t> ids;   // id of the group, `ranks` per pixel; 0: no further group
    std::vector<float> shares;        // share of the pixel, for each of `ids`
    std::uint64_t cut_pixels = 0;     // number of pixels with more groups than ranks
    float most_cut = 0;               // largest sum of the shares that these pixels leave out
};

class Film {
    using Stores = LayerStores<kLayers>;
    friend class KeptFilms;

  public:
    /// Bytes of the sums of a pixel. The lists of Layer::objects grow with the picture; counted here: two objects.
    static std::size_t pixel_bytes(const FilmLayout& layout) { return Stores::pixel_bytes(layout.layers); }
    /// Throws Error, before it allocates, for an invalid size or invalid layers.
    explicit Film(FilmLayout layout);
    Film(Film&&) = default;
    Film& operator=(Film&&) = default;
    ~Film();
    /// Sets all sums to zero.
    void clear();
    const FilmLayout& layout() const { return layout_; }
    /// Count that the layout asks for: number of bands or channels; 1 or 0 for the other layers.
    int count_of(Layer layer) const { return layout_.layers[layer]; }
    /// Sets the offset of the film's region in the full frame, px.
    void place(int offset_x, int offset_y) { layout_.offset_x = offset_x, layout_.offset_y = offset_y; }
    /// Sets the spectral responses of the channels. A film with channels needs them before its first sample. Throws Error
    /// for another number of channels.
    void set_responses(Responses responses);
    const Responses& responses() const { return responses_; }

    // Samples. Pixel coordinates are in the full frame; samples outside the film's region are ignored. A sample with light
    // that is NaN, Inf or beyond kMaxFilmValue adds nothing, no coverage either, and is counted as bad; count() still
    // counts it. Auxiliary values are checked by themselves, in add_aov().

    /// Counts a camera sample, once per sample and pixel. The count is the divisor of the mean.
    void count(int x, int y, std::uint32_t sample = 0);
    /// Adds the whole light of a camera sample in a pixel, because the variance needs the square of the sum. Not thread
    /// safe for the same pixel: tiles own their pixels.
    void add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    /// Like add(), but thread safe: locks the pixel. For lenses with dispersion, where wavelengths land in pixels of other
    /// tiles. No thread may call add() for the same pixel at the same time.
    void add_locked(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    /// Adds a colour to the picture, but not to bands and channels.
    void add(int x, int y, std::uint32_t sample, Vec3f xyz);
    void add_aov(int x, int y, std::uint32_t sample, const AovSample& aov);
    /// Adds the light of a path from an emitter to Layer::splats or Layer::flare. Thread safe. The mean divides these sums
    /// by the count of camera samples. Splats are separate from camera samples because their variance is estimated as for
    /// a compound Poisson process, sum(s^2) / n^2, without the square of the mean.
    void splat(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, Spectrum radiance,
               Layer layer = Layer::splats);
    /// Adds splats to adjacent pixels of a row, in a film without bands. In a film with channels, `channels` has their
    /// values for each pixel.
    void splat_row(int x, int y, std::uint32_t sample, std::span<const Vec3f> xyz, Layer layer,
                   std::span<const Spectrum> channels = {});
    /// Adds to the flare of adjacent pixels of a row within the region, in whole steps of the fixed-point sums: XYZ,
    /// squares of R, G and B, and the channels of each pixel. Thread safe.
    struct FlareSteps {
        std::array<Int128, 3> xyz{}, squares{};
    };
    void add_flare_row(int x, int y, std::span<const FlareSteps> steps, std::span<const Int128> channels);
    /// Prefetches the sums of pixels [x0, x1) x [y0, y1) into the cache, ahead of splats.
    void prefetch(int x0, int x1, int y0, int y1, Layer layer);

    /// Adds the sums of another film, exactly as if all samples had been drawn into this film. Throws Error if the layouts
    /// differ. The caller makes sure that the channels are from the same sensor: films read from files have no responses.
    void merge(const Film& other);

    // Pictures: rows from the top; 0 in pixels without samples. They throw Error if the film lacks the layer.

    /// Mean CIE XYZ per pixel, with splats and flare.
    std::vector<float> mean_xyz() const;
    /// Means of a layer over the camera samples: `count` values of each pixel, from value `first` on.
    static constexpr std::size_t kAll = ~std::size_t(0);
    std::vector<float> means(const std::string& layer, std::size_t first = 0, std::size_t count = kAll) const;
    /// Mean XYZ of the samples with even or with odd indices: of camera paths, or of light paths. The two halves share no
    /// sample, so their difference estimates their noise. Ghosts are left out.
    enum class Half { even, odd };
    std::vector<float> half_xyz(Half half, bool by_light_paths = false) const;
    /// Share of each pixel that objects cover.
    std::vector<float> coverage() const;
    /// Coverage by groups of objects. ids[k] is the id of the group of object k, not 0; objects beyond the span are in no
    /// group.
    Ranked ranked(std::span<const std::uint32_t> ids, int ranks) const;
    /// Mean of each channel of the sensor, with splats and flare.
    std::vector<float> mean_channels() const;
    /// Variance of the mean of linear Rec.709 R, G, B (see film_noise.cpp); 0 with fewer than two samples.
    std::vector<float> variance_rgb() const;
    /// Relative variance of one sample, estimated from the n samples of the pixel: n var(mean) / (mean^2 + dark), averaged
    /// over R, G and B.
    std::vector<float> relative_variance(float dark) const;
    std::vector<std::uint32_t> sample_counts() const;
    /// Mean of a channel of kAovChannels over the samples that have a value; 0 in pixels without these.
    std::vector<float> aov(const std::string& name) const;
    /// Object id of the sample with a hit that has the lowest index.
    std::vector<std::uint32_t> object_ids() const;
    /// Bad samples: the sample of lowest index in each of the first 100 pixels with bad samples. Neither the order of
    /// samples nor merging changes the list.
    std::vector<BadSample> bad_samples() const;
    std::uint64_t bad_sample_count() const;

    // The state: words of each layer as they are in memory; pass files store them.

    /// Names of the layers that the film keeps.
    std::vector<std::string> state_parts() const { return stores_.names(); }
    LayerState state(const std::string& part) const;
    /// Words of a pixel, or of an entry of a list.
    std::size_t words_of(const std::string& part) const;
    /// Throws Error for another number of bytes, or invalid lists of objects.
    void set_state(const std::string& part, std::span<const std::byte> bytes);
    /// Merges a layer of the state of a film of the same layout. `columns` are the indices, in rising order, of the words
    /// of a pixel that `words` has; the other words are 0. Lists of objects come with all words. `words` need not be
    /// aligned, as bytes from a network. Throws Error like set_state().
    void add_state(const std::string& part, std::span<const std::uint32_t> columns, std::span<const std::byte> words);

  private:
    template <Layer kLayer>
    auto& of() { return stores_.of<kLayer>(); }
    template <Layer kLayer>
    const auto& of() const { return stores_.of<kLayer>(); }
    /// Store of a layer; throws Error if the film does not keep the layer.
    template <Layer kLayer>
    const auto& require() const;

    /// Index of a full-frame pixel, or -1 outside the region.
    std::int64_t find(int x, int y) const {
        const std::int64_t column = std::int64_t(x) - layout_.offset_x, row = std::int64_t(y) - layout_.offset_y;
        const bool inside = column >= 0 && column < layout_.width && row >= 0 && row < layout_.height;
        return inside ? row * layout_.width + column : -1;
    }
    /// Sums of a layer that paths from emitters add to.
    Plane<ColorSums>& emitter_sums(Layer layer) {
        return layer == Layer::flare ? of<Layer::flare>() : of<Layer::splats>();
    }
    bool has_emitter_layers() const { return count_of(Layer::splats) || count_of(Layer::flare); }

    /// Sums of X, Y, Z over even-indexed samples (Layer::halves), for a camera sample, or for a splat to `layer`. Null
    /// for an odd index, or without such sums.
    ValueSum* even_sample_sums(std::size_t i, std::uint32_t sample);
    ValueSum* even_sample_sums(std::size_t i, std::uint32_t sample, Layer layer);
    /// Adds light to XYZ and bands. Returns false if the sample is bad.
    bool add_light(ColorSums& sums, ValueSum* even_sums, std::size_t i, std::uint32_t sample,
                   const Wavelengths& wavelengths, Spectrum radiance, bool squares = true);
    void add_arrived(std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    bool add_catchers(std::size_t i, const Wavelengths& wavelengths, const CameraLight& arrived);
    void add_coverage(std::size_t i, const CameraLight& arrived);
    /// Lock of a row of the region; for splats without bands, and for the channels of all splats.
    std::uint32_t& row_lock(int y) { return row_locks_[std::size_t(kLockStride) * (y - layout_.offset_y)]; }

    /// Sum of XYZ of a pixel, with splats and flare.
    Vec3d sum_xyz(std::size_t i) const;
    /// Sums of linear Rec.709 R, G, B, and the variances of their means.
    struct Estimate {
        double sum[3], variance[3];
    };
    Estimate estimate(std::size_t i) const;

    /// Film of this layout out of the memory that KeptFilms keeps; null: none. Frees kept memory of another layout, unless
    /// the new film is much smaller.
    static std::unique_ptr<Film> take_kept(const FilmLayout& layout);
    /// Bytes of all layers.
    std::size_t state_bytes() const;

    FilmLayout layout_;
    RgbRows rgb_from_xyz_;
    Stores stores_;
    // Locks of splats without bands, one per row. A lock in the pixel would cost a splat another cache line.
    static constexpr int kLockStride = 16;   // one per cache line
    std::vector<std::uint32_t> row_locks_;
    Responses responses_;
};

}  // namespace dg
