// film.h -- linear sums per pixel. Every sum is exact (fixed point, 128 bits), so that neither the order of samples, nor
// the number of threads, nor the way a frame was split and merged changes a bit. layers.h lists the layers of sums.
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

/// A sample that had to be dropped, with the place to look for it.
struct BadSample {
    int x, y;
    std::uint32_t sample;
};

/// Shares of pixels by group of objects, each group under its id: in each pixel those of the largest magnitude first.
struct Ranked {
    std::vector<std::uint32_t> ids;   // `ranks` per pixel; 0 where there are no more
    std::vector<float> shares;
    std::uint64_t cut_pixels = 0;     // with more groups than ranks
    float most_cut = 0;               // the largest share of a pixel that these leave out
};

class Film {
    using Stores = LayerStores<kLayers>;
    friend class KeptFilms;

  public:
    /// Bytes of the sums of one pixel, in which there are two objects, if objects are kept.
    static std::size_t pixel_bytes(const FilmLayout& layout) { return Stores::pixel_bytes(layout.layers); }
    /// Throws Error, before it takes memory, for a size or layers that no film can have.
    explicit Film(FilmLayout layout);
    Film(Film&&) = default;
    Film& operator=(Film&&) = default;
    ~Film();
    /// Takes all samples away.
    void clear();
    const FilmLayout& layout() const { return layout_; }
    /// Number of records that a layer may have in a pixel: of bands and channels; of others 1 or 0.
    int count_of(Layer layer) const { return layout_.layers[layer]; }
    /// Moves its region, in a frame that begins elsewhere.
    void place(int offset_x, int offset_y) { layout_.offset_x = offset_x, layout_.offset_y = offset_y; }
    /// Sets the weights of light in the channels, before a film with channels is drawn into. Throws
    /// Error for another number of channels.
    void set_responses(Responses responses);
    const Responses& responses() const { return responses_; }

    // Samples. Pixels are those of the full frame; outside the region all is ignored. A sample that is NaN, Inf or beyond
    // kMaxFilmValue is counted as bad, and 0 is added.

    /// Counts a camera sample, once per sample and pixel: the divisor of the mean.
    void count(int x, int y, std::uint32_t sample = 0);
    /// Adds the light of a camera sample, in one sum: its square is what the variance is made of. Not thread safe for
    /// the same pixel: tiles own their pixels.
    void add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    /// The same from any thread at any time, as dispersion sends wavelengths to the pixels of other tiles; a pixel that
    /// may be written like this must not be written by add() meanwhile.
    void add_shared(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    /// Adds a colour like add(), without bands and channels.
    void add(int x, int y, std::uint32_t sample, Vec3f xyz);
    void add_aov(int x, int y, std::uint32_t sample, const AovSample& aov);
    /// Adds the light of a path from an emitter, from any thread at any time, to Layer::splats or Layer::flare. Their
    /// sums are divided by the same count. Their squares tell the variance of independent arrivals (compound Poisson),
    /// from which no mean is to be taken off; so they are sums of their own.
    void splat(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, Spectrum radiance,
               Layer layer = Layer::splats);
    /// The same for pixels side by side, of a film without bands; with channels as many of their values.
    void splat_row(int x, int y, std::uint32_t sample, std::span<const Vec3f> xyz, Layer layer,
                   std::span<const Spectrum> channels = {});
    /// Adds whole steps of the sums to the flare of pixels side by side within the region: of XYZ, of the squares of R, G
    /// and B, and of the channels, as many per pixel as there are. From any thread at any time.
    struct FlareSteps {
        std::array<Int128, 3> xyz{}, squares{};
    };
    void add_flare_row(int x, int y, std::span<const FlareSteps> steps, std::span<const Int128> channels);
    /// Before splats to pixels [x0, x1) x [y0, y1): their sums come from memory while other things are done.
    void prefetch(int x0, int x1, int y0, int y1, Layer layer);

    /// Exact: a.merge(b) equals having drawn all samples into one film. Throws Error if
    /// layouts differ. That channels are of the same sensor is the caller's word: films out of files have no
    /// responses.
    void merge(const Film& other);

    // Pictures: rows from the top, 0 without samples. Error without the layer that they are made of.

    /// Mean CIE XYZ per pixel, all that was added.
    std::vector<float> mean_xyz() const;
    /// Means of a layer of plain sums over the samples of the pixel: `count` of a pixel's values, from `first` on.
    static constexpr std::size_t kAll = ~std::size_t(0);
    std::vector<float> means(const std::string& layer, std::size_t first = 0, std::size_t count = kAll) const;
    /// The pictures of samples with even and with odd indices. They share no sample, so their difference tells the noise
    /// of both. Light paths are apart, and ghosts are in neither.
    enum class Half { even, odd };
    std::vector<float> half_xyz(Half half, bool by_light_paths = false) const;
    /// Share of each pixel that objects cover.
    std::vector<float> coverage() const;
    /// The same by groups of objects: ids[k] is the id of the group of object k, not 0; an object beyond has none.
    Ranked ranked(std::span<const std::uint32_t> ids, int ranks) const;
    /// Mean of each channel, all that was added.
    std::vector<float> mean_channels() const;
    /// Variance of the mean of linear Rec.709 R, G, B (see film_noise.cpp); 0 for less
    /// than two samples.
    std::vector<float> variance_rgb() const;
    /// Relative variance of one sample, at least of two, as far as the n drawn tell: n times the variance
    /// of the mean over (mean^2 + dark), the mean of R, G and B.
    std::vector<float> relative_variance(float dark) const;
    std::vector<std::uint32_t> sample_counts() const;
    /// Mean over the samples that brought one, 0 where none did. Names: those of kAovChannels.
    std::vector<float> aov(const std::string& name) const;
    /// Object of the lowest sample index that hit something.
    std::vector<std::uint32_t> object_ids() const;
    /// The first bad sample of each of the first 100 pixels that have one; full-frame coordinates. Kept per pixel, so it
    /// depends on no order and survives merging.
    std::vector<BadSample> bad_samples() const;
    std::uint64_t bad_sample_count() const;

    // The state: words of each layer as they are in memory, which is what pass files store and read back.

    /// Names of the layers that the film keeps.
    std::vector<std::string> state_parts() const { return stores_.names(); }
    LayerState state(const std::string& part) const;
    /// Words of a pixel, or of an entry of a list.
    std::size_t words_of(const std::string& part) const;
    /// Throws Error for another number of bytes, or lists that no film has.
    void set_state(const std::string& part, std::span<const std::byte> bytes);
    /// Adds a part of the state of a film of the same layout, exactly as merge does. Of the words of each pixel only
    /// those of these columns come, in rising order; the others are 0. Of lists all words come. Bytes of a network
    /// need not be aligned. Throws Error like set_state().
    void add_state(const std::string& part, std::span<const std::uint32_t> columns, std::span<const std::byte> words);

  private:
    template <Layer kLayer>
    auto& of() { return stores_.of<kLayer>(); }
    template <Layer kLayer>
    const auto& of() const { return stores_.of<kLayer>(); }
    /// The same; Error if the film does not keep this layer.
    template <Layer kLayer>
    const auto& require() const;

    /// Index of a full-frame pixel, or -1 outside the region.
    std::int64_t find(int x, int y) const {
        const std::int64_t column = std::int64_t(x) - layout_.offset_x, row = std::int64_t(y) - layout_.offset_y;
        const bool inside = column >= 0 && column < layout_.width && row >= 0 && row < layout_.height;
        return inside ? row * layout_.width + column : -1;
    }
    Plane<ColorSums>& arrivals(Layer layer) { return layer == Layer::flare ? of<Layer::flare>() : of<Layer::splats>(); }
    bool lit() const { return count_of(Layer::splats) || count_of(Layer::flare); }   // by paths from emitters

    /// Sums of X, Y, Z that a sample goes to beside the pixel's own, or beside those of its splats; null: none.
    ValueSum* half(std::size_t i, std::uint32_t sample);
    ValueSum* half(std::size_t i, std::uint32_t sample, Layer layer);
    /// To XYZ and bands. False if the sample is bad.
    bool add_light(ColorSums& sums, ValueSum* half, std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths,
                   Spectrum radiance, bool squares = true);
    void add_arrived(std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    bool add_set(std::size_t i, const Wavelengths& wavelengths, const CameraLight& arrived);
    void add_coverage(std::size_t i, const CameraLight& arrived);
    /// Lock of a row of the region; for splats without bands, and for the channels of all splats.
    std::uint32_t& row_lock(int y) { return row_locks_[std::size_t(kLockStride) * (y - layout_.offset_y)]; }

    /// Sum of all that was added to the pixel of this index.
    Vec3d sum_xyz(std::size_t i) const;
    /// Sums of linear Rec.709 R, G, B, and the variances of their means.
    struct Estimate {
        double sum[3], variance[3];
    };
    Estimate estimate(std::size_t i) const;

    /// Film of this layout in memory that is kept; null: there is none. Memory of another layout is given up first, unless
    /// this film is small beside it.
    static std::unique_ptr<Film> take_kept(const FilmLayout& layout);
    /// Bytes of all planes.
    std::size_t state_bytes() const;

    FilmLayout layout_;
    RgbRows rgb_from_xyz_;
    Stores stores_;
    // Locks of splats without bands, a row at a time. Apart from the pixels, which a splat would have to fetch for it.
    static constexpr int kLockStride = 16;   // one per cache line
    std::vector<std::uint32_t> row_locks_;
    Responses responses_;
};

}  // namespace dg
