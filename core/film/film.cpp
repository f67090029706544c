// film.cpp -- adding to the exact sums of a film, and merging films.
#include "film/film.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "math/cancel.h"
#include "math/error.h"
#include "spectrum/wavelengths.h"

namespace dg {
namespace {

Vec3f float_transform(const std::array<Vec3f, 3>& rows, Vec3f v) {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

/// Values of a sample for the channels, in their order; 0 where it has none.
std::array<float, kAovChannels.size()> aov_values(const AovSample& s) {
    std::array<float, kAovChannels.size()> values{};
    for (std::size_t k = 0; k < values.size(); ++k)
        if (s.hit || !kAovChannels[k].of_hits) values[k] = kAovChannels[k].value(s);
    return values;
}

/// Holds a pixel, or a row, that several threads may write.
class Lock {
  public:
    explicit Lock(std::uint32_t& word) : lock_(word) {
        while (lock_.exchange(1, std::memory_order_acquire)) std::this_thread::yield();
    }
    ~Lock() { lock_.store(0, std::memory_order_release); }

  private:
    std::atomic_ref<std::uint32_t> lock_;
};

/// Resizes bit by bit, so that work that is cancelled need not wait for the zeros of a large film.
template <class T>
void make_room(std::vector<T>& all, std::size_t count) {
    constexpr std::size_t kStep = 1 << 16;
    all.reserve(count);
    while (all.size() < count) {
        throw_if_cancelled();
        all.resize(std::min(count, all.size() + kStep));
    }
}

}  // namespace

Film::Film(FilmLayout layout) : layout_(layout) {
    const std::int64_t pixels = std::int64_t(layout.width) * layout.height;
    if (layout.width < 1 || layout.height < 1 || pixels > (std::int64_t(1) << 31))
        throw input_error(
            "film", "size in px", "at least 1 x 1 and at most 2^31 pixels",
            std::to_string(layout.width) + " x " + std::to_string(layout.height));
    const Vec3f x = rgb_from_xyz({1, 0, 0}), y = rgb_from_xyz({0, 1, 0}),
                z = rgb_from_xyz({0, 0, 1});
    for (int i = 0; i < 3; ++i) rgb_from_xyz_[i] = {x[i], y[i], z[i]};
    if (std::unique_ptr<Film> kept = take_kept(layout)) {
        *this = std::move(*kept);
        clear();
        responses_ = {};
        return;
    }
    make_room(pixels_, pixels);
    if (layout.aovs) make_room(aovs_, pixels);
    if (layout.splats) make_room(splats_, pixels);
    if (layout.flare) make_room(flare_, pixels);
    if (layout.halves) make_room(halves_, pixels);
    if (layout.coverage) make_room(coverage_, pixels);
    if (layout.objects) objects_ = std::make_unique<CoverLists>(pixels);
    if (layout.catchers) make_room(catchers_, pixels);
    if (layout.splats || layout.flare) make_room(row_locks_, std::size_t(kLockStride) * layout.height);
    if (layout.objects && !layout.coverage)
        throw Error("film: objects need coverage");
    if (layout.bands < 0 || layout.bands > kMostBands)
        throw input_error("film", "bands", "0 to " + std::to_string(kMostBands),
                          std::to_string(layout.bands));
    if (layout.channels < 0 || layout.channels > Responses::kMost)
        throw input_error("film", "channels", "0 to " + std::to_string(Responses::kMost),
                          std::to_string(layout.channels));
    make_room(bands_, std::size_t(pixels) * layout.bands);
    make_room(channels_, std::size_t(pixels) * layout.channels);
    if (layout.splats || layout.flare) make_room(channel_splats_, channels_.size());
    if (layout.catchers) make_room(catcher_channels_, 2 * channels_.size());
}

void Film::set_responses(Responses responses) {
    if (responses.count() != layout_.channels)
        throw input_error("film", "responses", std::to_string(layout_.channels) + " channels",
                          std::to_string(responses.count()));
    responses_ = std::move(responses);
}

std::int64_t Film::find(int x, int y) const {
    const std::int64_t column = std::int64_t(x) - layout_.offset_x;
    const std::int64_t row = std::int64_t(y) - layout_.offset_y;
    const bool inside =
        column >= 0 && column < layout_.width && row >= 0 && row < layout_.height;
    return inside ? row * layout_.width + column : -1;
}

void Film::mark_bad(Pixel& pixel, std::uint32_t sample) {
    ++pixel.bad;
    pixel.first_bad = std::min(pixel.first_bad, sample);
}

void Film::add(int x, int y, std::uint32_t sample, Vec3f xyz) {
    const std::int64_t i = find(x, y);
    if (i >= 0 && !add_to(pixels_[i], half(i, sample), xyz)) mark_bad(pixels_[i], sample);
}

void Film::add_shared(int x, int y, std::uint32_t sample, Vec3f xyz) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    const Lock lock(pixels_[i].lock);
    if (!add_to(pixels_[i], half(i, sample), xyz)) mark_bad(pixels_[i], sample);
}

Film::Sums& Film::sums_of(Layer layer, std::size_t i) {
    std::vector<Sums>& sums = layer == Layer::splats ? splats_ : flare_;
    DG_CHECK(sums.size(), >, i);
    return sums[i];
}

void Film::splat(int x, int y, std::uint32_t sample, Vec3f xyz, Layer layer) {
    if (find(x, y) >= 0) splat_row(x, y, sample, std::span(&xyz, 1), layer);
}

void Film::splat_row(int x, int y, std::uint32_t sample, std::span<const Vec3f> xyz, Layer layer,
                     std::span<const Spectrum> channels) {
    const std::int64_t first = find(x, y);
    DG_CHECK(first, >=, 0);
    Sums* const sums = &sums_of(layer, first + xyz.size() - 1) - (xyz.size() - 1);
    const Lock lock(row_lock(y));
    for (std::size_t k = 0; k < xyz.size(); ++k) {
        if (xyz[k] == Vec3f{0, 0, 0} && channels.empty()) continue;
        if (add_to(sums[k], half(first + k, sample, layer), xyz[k])) {
            if (!channels.empty()) add_channels(channel_splats_, first + k, channels[k]);
            continue;
        }
        const Lock pixel(pixels_[first + k].lock);
        mark_bad(pixels_[first + k], sample);
    }
}

void Film::add_flare_row(int x, int y, std::span<const FlareSteps> steps, std::span<const Int128> channels) {
    const std::int64_t first = find(x, y);
    DG_CHECK(first, >=, 0);
    Sums* const sums = &sums_of(Layer::flare, first + steps.size() - 1) - (steps.size() - 1);
    const Lock lock(row_lock(y));
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            sums[i].xyz[k].add_steps(steps[i].xyz[k]);
            sums[i].rgb_squares[k].add_steps(steps[i].squares[k]);
        }
    for (std::size_t i = 0; i < channels.size(); ++i)
        channel_splats_[first * layout_.channels + i].add_steps(channels[i]);
}

void Film::prefetch(int x0, int x1, int y0, int y1, Layer layer) const {
    constexpr std::size_t kLine = 64;   // bytes
    const std::vector<Sums>& sums = layer == Layer::splats ? splats_ : flare_;
    const int left = std::max(x0, layout_.offset_x), right = std::min(x1, layout_.offset_x + layout_.width),
              bottom = std::min(y1, layout_.offset_y + layout_.height);
    if (left >= right || sums.empty()) return;
    for (int y = std::max(y0, layout_.offset_y); y < bottom; ++y) {
        const char* const row = reinterpret_cast<const char*>(sums.data() + find(left, y));
        for (std::size_t at = 0; at < std::size_t(right - left) * sizeof(Sums); at += kLine)
            __builtin_prefetch(row + at, 1);
    }
}

void Film::add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths,
               const CameraLight& arrived) {
    if (layout_.bands && (layout_.splats || layout_.flare))   // they share the sums of bands
        return add_shared(x, y, sample, wavelengths, arrived);
    const std::int64_t i = find(x, y);
    if (i >= 0) add_arrived(i, sample, wavelengths, arrived);
}

void Film::add_shared(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths,
                      const CameraLight& arrived) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    const Lock lock(pixels_[i].lock);
    add_arrived(i, sample, wavelengths, arrived);
}

void Film::add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, Spectrum radiance) {
    add(x, y, sample, wavelengths, CameraLight{.light = radiance});
}

void Film::add_shared(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, Spectrum radiance) {
    add_shared(x, y, sample, wavelengths, CameraLight{.light = radiance});
}

void Film::add_arrived(std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths,
                       const CameraLight& arrived) {
    if (layout_.coverage) add_coverage(i, arrived);
    if (layout_.catchers && !add_set(i, wavelengths, arrived)) return mark_bad(pixels_[i], sample);
    const bool alone = !layout_.catchers;
    if (add_light(pixels_[i], half(i, sample), i, sample, wavelengths, arrived.light, alone) && layout_.channels)
        add_channels(channels_, i, responses_.of(wavelengths, arrived.light));
}

/// Adds light of the set. The picture's noise is that of what comes into the plate, light and change: their squares
/// replace those of the light alone, which add_light() adds.
bool Film::add_set(std::size_t i, const Wavelengths& wavelengths, const CameraLight& arrived) {
    const Vec3f light = wavelengths.to_xyz(arrived.light), with = wavelengths.to_xyz(arrived.with),
                without = wavelengths.to_xyz(arrived.without);
    for (int k = 0; k < 3; ++k)
        if (!fits_film(light[k]) || !fits_film(with[k]) || !fits_film(without[k])) return false;
    CatcherPixel& pixel = catchers_[i];
    for (int k = 0; k < 3; ++k) pixel.with[k].add(with[k]), pixel.without[k].add(without[k]);
    add_squares(pixels_[i], light + with - without);
    if (!layout_.channels) return true;
    add_channels(catcher_channels_, 2 * i, responses_.of(wavelengths, arrived.with));
    add_channels(catcher_channels_, 2 * i + 1, responses_.of(wavelengths, arrived.without));
    return true;
}

void Film::add_coverage(std::size_t i, const CameraLight& arrived) {
    coverage_[i].white += coverage_steps(arrived.white);
    coverage_[i].covered += coverage_steps(arrived.covered);
    if (!objects_) return;
    for (const ObjectCover& c : std::span(arrived.objects.data(), arrived.object_count))
        objects_->add(i, c.object, coverage_steps(c.covered));
}

void Film::splat(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths,
                 Spectrum radiance, Layer layer) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    const Spectrum channels = layout_.channels ? responses_.of(wavelengths, radiance) : Spectrum();
    if (!layout_.bands) {
        const Vec3f xyz = wavelengths.to_xyz(radiance);
        const std::span<const Spectrum> values(&channels, layout_.channels ? 1 : 0);
        return splat_row(x, y, sample, std::span(&xyz, 1), layer, values);
    }
    {
        const Lock lock(pixels_[i].lock);
        if (!add_light(sums_of(layer, i), half(i, sample, layer), i, sample, wavelengths, radiance)) return;
    }
    const Lock lock(row_lock(y));
    add_channels(channel_splats_, i, channels);
}

bool Film::add_light(Sums& sums, ValueSum* half, std::size_t i, std::uint32_t sample,
                     const Wavelengths& wavelengths, Spectrum radiance, bool squares) {
    if (!add_to(sums, half, wavelengths.to_xyz(radiance), squares)) {
        mark_bad(pixels_[i], sample);
        return false;
    }
    if (layout_.bands) add_bands(&bands_[i * layout_.bands], wavelengths, radiance);
    return true;
}

void Film::add_bands(ValueSum* bands, const Wavelengths& wavelengths, Spectrum radiance) const {
    const float per_nm = float(layout_.bands) / (kMaxWavelength - kMinWavelength);
    const Spectrum light = radiance * wavelengths.measure() * per_nm;
    for (int k = 0; k < kWavelengths; ++k) {
        const int band = int((wavelengths.nm[k] - kMinWavelength) * per_nm);
        if (fits_film(light[k])) bands[std::min(band, layout_.bands - 1)].add(light[k]);
    }
}

void Film::add_channels(std::vector<ValueSum>& channels, std::size_t i, Spectrum values) const {
    for (int c = 0; c < layout_.channels; ++c)
        if (fits_film(values[c])) channels[i * layout_.channels + c].add(values[c]);
}

ValueSum* Film::half(std::size_t i, std::uint32_t sample) {
    return halves_.empty() || sample % 2 ? nullptr : halves_[i].own;
}

ValueSum* Film::half(std::size_t i, std::uint32_t sample, Layer layer) {
    return halves_.empty() || sample % 2 || layer != Layer::splats ? nullptr : halves_[i].splats;
}

bool Film::add_to(Sums& sums, ValueSum* half, Vec3f xyz, bool squares) const {
    if (!(fits_film(xyz.x) && fits_film(xyz.y) && fits_film(xyz.z))) return false;
    sums.xyz[0].add(xyz.x);
    sums.xyz[1].add(xyz.y);
    sums.xyz[2].add(xyz.z);
    if (half) half[0].add(xyz.x), half[1].add(xyz.y), half[2].add(xyz.z);
    if (squares) add_squares(sums, xyz);
    return true;
}

void Film::add_squares(Sums& sums, Vec3f xyz) const {
    const Vec3d rgb = to_double(float_transform(rgb_from_xyz_, xyz));
    sums.rgb_squares[0].add(std::min(rgb.x * rgb.x, kMaxFilmSquare));
    sums.rgb_squares[1].add(std::min(rgb.y * rgb.y, kMaxFilmSquare));
    sums.rgb_squares[2].add(std::min(rgb.z * rgb.z, kMaxFilmSquare));
}

void Film::count(int x, int y, std::uint32_t sample) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    ++pixels_[i].count;
    if (!halves_.empty() && sample % 2 == 0) ++halves_[i].count;
}

void Film::add_aov(int x, int y, std::uint32_t sample, const AovSample& aov) {
    const std::int64_t i = find(x, y);
    if (i < 0 || aovs_.empty()) return;
    const auto values = aov_values(aov);
    if (!std::ranges::all_of(values, fits_film)) {
        const Lock lock(pixels_[i].lock);
        mark_bad(pixels_[i], sample);
        return;
    }
    AovPixel& pixel = aovs_[i];
    for (std::size_t k = 0; k < values.size(); ++k) pixel.sums[k].add(values[k]);
    ++pixel.passed;
    if (!aov.hit) return;
    ++pixel.hits;
    if (sample < pixel.object_sample) {
        pixel.object_sample = sample;
        pixel.object_id = aov.object_id;
    }
}

void Film::Sums::add(const Sums& other) {
    for (int k = 0; k < 3; ++k) xyz[k].add(other.xyz[k]);
    for (int k = 0; k < 3; ++k) rgb_squares[k].add(other.rgb_squares[k]);
}

namespace {

template <typename T>
void add_all(std::vector<T>& to, const std::vector<T>& more) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].add(more[i]);
}

}  // namespace

void Film::merge(const Film& other) {
    if (!(layout_ == other.layout_)) {
        const auto words = [](const FilmLayout& l) {
            return std::to_string(l.width) + " x " + std::to_string(l.height) +
                   " px at (" + std::to_string(l.offset_x) + ", " +
                   std::to_string(l.offset_y) + ")" +
                   (l.aovs ? " with aovs" : " without aovs") +
                   (l.splats ? ", with light paths" : "") + (l.flare ? ", with flare" : "") +
                   (l.halves ? ", with halves" : "") + (l.coverage ? ", with coverage" : "") +
                   (l.objects ? ", with objects" : "") +
                   (l.catchers ? ", with catchers" : "") +
                   (l.bands ? ", " + std::to_string(l.bands) + " bands" : "") +
                   (l.channels ? ", " + std::to_string(l.channels) + " channels" : "");
        };
        throw input_error("film", "merge", words(layout_), words(other.layout_));
    }
    add_all(pixels_, other.pixels_);
    add_all(splats_, other.splats_);
    add_all(flare_, other.flare_);
    add_all(halves_, other.halves_);
    add_all(coverage_, other.coverage_);
    if (objects_) objects_->add(*other.objects_);
    add_all(catchers_, other.catchers_);
    add_all(catcher_channels_, other.catcher_channels_);
    add_all(bands_, other.bands_);
    add_all(channels_, other.channels_);
    add_all(channel_splats_, other.channel_splats_);
    add_all(aovs_, other.aovs_);
}

void Film::Pixel::add(const Pixel& other) {
    Sums::add(other);
    count += other.count;
    bad += other.bad;
    first_bad = std::min(first_bad, other.first_bad);
}

void Film::HalfPixel::add(const HalfPixel& other) {
    for (int k = 0; k < 3; ++k) own[k].add(other.own[k]), splats[k].add(other.splats[k]);
    count += other.count;
}

void Film::CoveragePixel::add(const CoveragePixel& other) {
    white += other.white;
    covered += other.covered;
}

void Film::CatcherPixel::add(const CatcherPixel& other) {
    for (int k = 0; k < 3; ++k) with[k].add(other.with[k]), without[k].add(other.without[k]);
}

void Film::AovPixel::add(const AovPixel& other) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k].add(other.sums[k]);
    passed += other.passed;
    hits += other.hits;
    if (other.object_sample < object_sample) {
        object_sample = other.object_sample;
        object_id = other.object_id;
    }
}

}  // namespace dg
