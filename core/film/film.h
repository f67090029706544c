// film.h -- linear sums per pixel. Every sum is exact (fixed point, 128 bits), so that
// neither the order of samples, nor the number of threads, nor the way a frame was split
// and merged changes a bit.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "film/aov.h"
#include "film/cover_lists.h"
#include "film/fixed_sum.h"
#include "math/vec.h"
#include "spectrum/responses.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// Part of a sample's coverage that is one object's, by any number.
struct ObjectCover {
    std::uint32_t object;
    float covered;
};

/// Light that one camera sample brings to one pixel, and how much of the pixel its objects cover. In a film with
/// catchers `light` is the objects' alone, beside what the set sends with them there and without.
struct CameraLight {
    Spectrum light{0.f}, with{0.f}, without{0.f};
    float white = 0;     // what a white world would bring: the weight of this sample's coverage
    float covered = 0;   // as much of it as objects cover
    static constexpr std::size_t kMostObjects = 4;
    std::array<ObjectCover, kMostObjects> objects{};   // the same by object, of the first
    std::size_t object_count = 0;
};

/// A sample that had to be dropped, with the place to look for it.
struct BadSample {
    int x, y;
    std::uint32_t sample;
};

struct FilmLayout {
    int width = 0, height = 0;       // of the region that is stored
    int offset_x = 0, offset_y = 0;  // of that region in the full frame
    bool aovs = false;
    bool splats = false;             // light paths may add to any pixel (Film::splat)
    bool flare = false;              // and so may ghosts
    bool halves = false;             // with the picture of every other sample beside that of all, without ghosts
    bool coverage = false;           // share of each pixel that objects cover
    bool objects = false;            // and each object's share of that
    bool catchers = false;           // light of the set beside that of the objects
    int bands = 0;                   // of equal width over all wavelengths, kept beside XYZ
    int channels = 0;                // of a sensor, likewise (Film::set_responses)
    friend bool operator==(const FilmLayout&, const FilmLayout&) = default;
};

/// Pixels [x0, x1) x [y0, y1) of the full frame.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

/// Shares of pixels by group of objects, each group under its id: in each pixel those of the largest magnitude first.
struct Ranked {
    std::vector<std::uint32_t> ids;   // `ranks` per pixel; 0 where there are no more
    std::vector<float> shares;
    std::uint64_t cut_pixels = 0;     // with more groups than ranks
    float most_cut = 0;               // the largest share of a pixel that these leave out
};

/// 112 bytes per pixel; 272 more with aovs, 96 with splats, 96 with flare, 112 with halves, 16 with coverage, 4 with
/// objects and 16 for each of those in the pixel, 96 with catchers, 16 with each band, 16 with each channel, as much again
/// if there are splats or flare, and twice if there are catchers.
class Film {
    friend class KeptFilms;

  public:
    /// Bytes of the sums of one pixel, in which there are two objects, if objects are kept.
    static std::size_t pixel_bytes(const FilmLayout& layout);
    /// Throws Error unless 1 <= width, height and both fit in 2^31 pixels, bands is 0 .. kMostBands and
    /// channels is 0 .. Responses::kMost.
    explicit Film(FilmLayout layout);
    Film(Film&&) = default;
    Film& operator=(Film&&) = default;
    ~Film();
    /// Takes all samples away.
    void clear();
    const FilmLayout& layout() const { return layout_; }
    /// Says where its region lies from now on: in a frame that begins elsewhere.
    void place(int offset_x, int offset_y) { layout_.offset_x = offset_x, layout_.offset_y = offset_y; }
    /// Sets the weights of light in the channels, before a film with channels is drawn into. Throws
    /// Error for another number of channels.
    void set_responses(Responses responses);
    const Responses& responses() const { return responses_; }

    /// Adds one sample to a pixel (full-frame coordinates; outside the region: ignored).
    /// NaN, Inf or beyond kMaxFilmValue: the sample is counted as bad, and 0 is added.
    /// What one camera sample brings to one pixel should come as one sum: its square is
    /// what the variance is made of. Not thread safe for the same pixel: tiles own their
    /// pixels; see add_shared.
    void add(int x, int y, std::uint32_t sample, Vec3f xyz);
    /// Values that are not finite: counted as bad, nothing added.
    void add_aov(int x, int y, std::uint32_t sample, const AovSample& aov);
    /// To be called once per camera sample and pixel: the divisor of the mean.
    void count(int x, int y, std::uint32_t sample = 0);
    /// The same from any thread at any time, as dispersion sends wavelengths to the pixels of other
    /// tiles; a pixel that may be written like this must not be written by add() meanwhile.
    void add_shared(int x, int y, std::uint32_t sample, Vec3f xyz);
    /// Adds the light of a light path, from any thread at any time; the layout has splats. Their sums are divided
    /// by the same count. Their squares tell the variance of independent arrivals (compound Poisson), from
    /// which no mean is to be taken off; so they are sums of their own.
    enum class Layer { splats, flare };
    void splat(int x, int y, std::uint32_t sample, Vec3f xyz, Layer layer = Layer::splats);
    /// The same for pixels side by side within the region, of a film without bands; with channels as many of
    /// their values.
    void splat_row(int x, int y, std::uint32_t sample, std::span<const Vec3f> xyz, Layer layer,
                   std::span<const Spectrum> channels = {});
    /// Adds the light of a sample's wavelengths to XYZ, to their bands and to the channels: what the three
    /// above do with a colour.
    void add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, Spectrum radiance);
    void add_shared(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths,
                    Spectrum radiance);
    void splat(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths,
               Spectrum radiance, Layer layer = Layer::splats);
    /// The same with coverage, and with the light of the set.
    void add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    void add_shared(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    /// Adds whole steps of the sums to the flare of pixels side by side within the region: of XYZ, of the squares of R, G
    /// and B, and of the channels, as many per pixel as there are. From any thread at any time.
    struct FlareSteps {
        std::array<Int128, 3> xyz{}, squares{};
    };
    void add_flare_row(int x, int y, std::span<const FlareSteps> steps, std::span<const Int128> channels);
    /// Before splats to pixels [x0, x1) x [y0, y1): their sums come from memory while other things are done.
    void prefetch(int x0, int x1, int y0, int y1, Layer layer) const;

    /// Exact: a.merge(b) equals having drawn all samples into one film. Throws Error if
    /// layouts differ. That channels are of the same sensor is the caller's word: films out of files have no
    /// responses.
    void merge(const Film& other);

    /// Mean CIE XYZ per pixel, float32 rows from the top, size 3*width*height; 0 without
    /// samples.
    std::vector<float> mean_xyz() const;
    /// The share of it that light paths or ghosts brought; Error without that layer.
    std::vector<float> layer_xyz(Layer layer) const;
    std::vector<float> flare_xyz() const { return layer_xyz(Layer::flare); }
    /// The picture of the samples with even indices, and that of the others: two that have no sample in common, whose
    /// difference tells what noise both have. What light paths brought is apart, and ghosts are in neither. 0 without
    /// samples; Error without halves.
    enum class Half { even, odd };
    std::vector<float> half_xyz(Half half, bool by_light_paths = false) const;
    /// Share of each pixel that objects cover; Error without coverage.
    std::vector<float> coverage() const;
    /// The same by groups of objects: ids[k] is the id of the group of object k, not 0; an object beyond has none. Error
    /// without objects.
    Ranked ranked(std::span<const std::uint32_t> ids, int ranks) const;
    /// Mean XYZ of the light of the set, with the objects there or without; Error without catchers.
    std::vector<float> set_xyz(bool with_objects) const;
    /// The same in the channels.
    std::vector<float> set_channels(bool with_objects) const;
    /// Mean radiance of each band, all that was added, size bands*width*height; D65 of luminance 1 has
    /// some 1 in each. Throws Error for a film without bands.
    std::vector<float> mean_bands() const;
    /// Mean of each channel, all that was added, size channels*width*height. Throws Error for a film without.
    std::vector<float> mean_channels() const;
    /// Variance of the mean of linear Rec.709 R, G, B (see film_read.cpp); 0 for less
    /// than two samples.
    std::vector<float> variance_rgb() const;
    /// Relative variance of one sample, at least of two, as far as the n drawn tell: n times the variance
    /// of the mean over (mean^2 + dark), the mean of R, G and B.
    std::vector<float> relative_variance(float dark) const;
    std::vector<std::uint32_t> sample_counts() const;
    /// Mean over the samples that brought one, 0 where none did. Names: those of kAovChannels; else
    /// Error.
    std::vector<float> aov(const std::string& name) const;
    /// Object of the lowest sample index that hit something.
    std::vector<std::uint32_t> object_ids() const;

    /// The first bad sample of each of the first 100 pixels that have one, rows from the
    /// top; full-frame coordinates. Kept per pixel, so it depends on no order and
    /// survives merging.
    std::vector<BadSample> bad_samples() const;
    std::uint64_t bad_sample_count() const;

    /// The whole state as it lies in memory, which is what pass files store and read back:
    /// "sums", and "aovs", "splats", "flare", "halves", "coverage", "catchers", "bands", "channels", "channel_splats" and
    /// "catcher_channels" if there are any, so many bytes per pixel (per band or channel).
    static constexpr std::size_t kSumBytes = 112, kSplatBytes = 96, kHalfBytes = 112, kBandBytes = 16;
    static constexpr std::size_t kCoverageBytes = 16, kCatcherBytes = 96;
    static constexpr std::size_t kAovBytes = 16 * (kAovChannels.size() + 1);
    static constexpr int kMostBands = 64;
    std::vector<std::string> state_parts() const;
    std::span<const std::byte> state(const std::string& part) const;
    /// Those of the objects are lists, of any length: rows of CoverLists::words(), made anew; empty without objects.
    std::vector<std::uint32_t> object_words() const;
    void set_object_words(std::span<const std::uint32_t> words);
    /// Throws Error for another number of bytes.
    void set_state(const std::string& part, std::span<const std::byte> bytes);
    /// Adds a part of the state of a film of the same layout, exactly as merge does. Of the words of each pixel only
    /// those of these columns come, in rising order; the others are 0. Bytes of a network lie anywhere, so these need
    /// not be aligned. Throws Error for another number of bytes.
    void add_state(const std::string& part, std::span<const std::uint32_t> columns, std::span<const std::byte> words);
    void add_object_words(std::span<const std::uint32_t> words);

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    struct Sums {
        ValueSum xyz[3];
        SquareSum rgb_squares[3];
        void add(const Sums& other);
    };
    struct Pixel : Sums {
        std::uint32_t count = 0, bad = 0, first_bad = kNone;
        std::uint32_t lock = 0;   // of add_shared; 0 at rest
        void add(const Pixel& other);
    };
    struct HalfPixel {   // of the samples with even indices
        ValueSum own[3], splats[3];
        std::uint32_t count = 0, unused[3] = {};
        void add(const HalfPixel& other);
    };
    /// Whole steps of 2^-30: 2^33 samples of white fit.
    struct CoveragePixel {
        std::int64_t white = 0, covered = 0;
        void add(const CoveragePixel& other);
    };
    struct CatcherPixel {
        ValueSum with[3], without[3];
        void add(const CatcherPixel& other);
    };
    struct AovPixel {
        std::array<ValueSum, kAovChannels.size()> sums;   // in their order
        std::uint32_t passed = 0, hits = 0, object_sample = kNone, object_id = 0;
        void add(const AovPixel& other);
    };

    /// Index of a full-frame pixel, or -1 outside the region.
    std::int64_t find(int x, int y) const;
    /// Those of a pixel's splats; the layout has that layer.
    Sums& sums_of(Layer layer, std::size_t i);
    /// Sums of X, Y, Z that a sample goes to beside the pixel's own, or beside those of its splats; null: none.
    ValueSum* half(std::size_t i, std::uint32_t sample);
    ValueSum* half(std::size_t i, std::uint32_t sample, Layer layer);
    /// To a pixel's own sums, or to those of its splats, and to half of them if there are any; false if the sample is bad.
    bool add_to(Sums& sums, ValueSum* half, Vec3f xyz, bool squares = true) const;
    void add_squares(Sums& sums, Vec3f xyz) const;
    /// Under the pixel's lock, if there is need of one.
    void add_arrived(std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived);
    bool add_set(std::size_t i, const Wavelengths& wavelengths, const CameraLight& arrived);
    void add_coverage(std::size_t i, const CameraLight& arrived);
    /// To XYZ and bands. Splats and samples share the sums of bands: under the pixel's lock. False if bad.
    bool add_light(Sums& sums, ValueSum* half, std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths,
                   Spectrum radiance, bool squares = true);
    void add_bands(ValueSum* bands, const Wavelengths& wavelengths, Spectrum radiance) const;
    void add_channels(std::vector<ValueSum>& channels, std::size_t i, Spectrum values) const;
    /// Lock of a row of the region; for splats without bands, and for the channels of all splats.
    std::uint32_t& row_lock(int y) { return row_locks_[std::size_t(kLockStride) * (y - layout_.offset_y)]; }
    /// Sum of all that was added to the pixel of this index.
    Vec3d sum_xyz(std::size_t i) const;
    /// Sums of linear Rec.709 R, G, B, and the variances of their means.
    struct Estimate {
        double sum[3], variance[3];
    };
    Estimate estimate(std::size_t i) const;
    static void mark_bad(Pixel& pixel, std::uint32_t sample);
    /// Sums of `each` values per pixel over the pixel's count.
    std::vector<float> means(const std::vector<ValueSum>& sums, int each) const;
    const std::vector<AovPixel>& require_aovs() const;
    /// Calls `act` with the values of a part of a film, which is one of state_parts().
    template <typename Self, typename Act>
    static void with_part(Self& film, const std::string& part, const Act& act);

    /// Film of this layout whose memory is kept; null: there is none. Memory of another layout is given up first, unless
    /// this film is small beside it.
    static std::unique_ptr<Film> take_kept(const FilmLayout& layout);
    /// Bytes of all parts of the state.
    std::size_t state_bytes() const;

    FilmLayout layout_;
    std::array<Vec3f, 3> rgb_from_xyz_;  // rows
    std::vector<Pixel> pixels_;
    std::vector<AovPixel> aovs_;
    std::vector<Sums> splats_, flare_;
    std::vector<HalfPixel> halves_;
    std::vector<CoveragePixel> coverage_;
    std::unique_ptr<CoverLists> objects_;
    std::vector<CatcherPixel> catchers_;
    // Locks of splats without bands, a row at a time. Apart from the pixels, which a splat would have to fetch for it.
    static constexpr int kLockStride = 16;   // one per cache line
    std::vector<std::uint32_t> row_locks_;
    std::vector<ValueSum> bands_, channels_, channel_splats_;   // those of a pixel side by side
    std::vector<ValueSum> catcher_channels_;   // with the objects, then without
    Responses responses_;
};

/// While one lives, the memory of a film that ends waits for the next film of the same layout, as new memory costs time:
/// the system clears it page by page. A film of about its size, or larger, of another layout ends the wait.
class KeptFilms {
  public:
    /// Memory that waits.
    static std::size_t bytes();
    KeptFilms();
    ~KeptFilms();
    KeptFilms(const KeptFilms&) = delete;
    KeptFilms& operator=(const KeptFilms&) = delete;
};

}  // namespace dg
