// film_add.cpp -- adding samples of the camera, and light of paths from emitters, to the sums of a film.
#include <algorithm>
#include <atomic>
#include <thread>

#include "film/film.h"
#include "math/error.h"
#include "spectrum/wavelengths.h"

namespace dg {
namespace {

/// Values of a sample for each of kAovChannels; 0 for channels of hits if the sample has none.
std::array<float, kAovChannels.size()> aov_values(const AovSample& s) {
    std::array<float, kAovChannels.size()> values{};
    for (std::size_t k = 0; k < values.size(); ++k)
        if (s.hit || !kAovChannels[k].of_hits) values[k] = kAovChannels[k].value(s);
    return values;
}

/// Spin lock of a pixel, or of a row, that several threads may write.
class Lock {
  public:
    explicit Lock(std::uint32_t& word) : lock_(word) {
        while (lock_.exchange(1, std::memory_order_acquire)) std::this_thread::yield();
    }
    ~Lock() { lock_.store(0, std::memory_order_release); }

  private:
    std::atomic_ref<std::uint32_t> lock_;
};

/// Adds a colour to sums of a pixel, and to `even_sums` unless null (see Film::even_sample_sums). Returns false if the
/// sample is bad.
bool add_color(ColorSums& sums, ValueSum* even_sums, const RgbRows& rgb_from_xyz, Vec3f xyz, bool squares = true) {
    if (!(fits_film(xyz.x) && fits_film(xyz.y) && fits_film(xyz.z))) return false;
    sums.xyz[0].add(xyz.x);
    sums.xyz[1].add(xyz.y);
    sums.xyz[2].add(xyz.z);
    if (even_sums) even_sums[0].add(xyz.x), even_sums[1].add(xyz.y), even_sums[2].add(xyz.z);
    if (squares) sums.add_squares(rgb_from_xyz, xyz);
    return true;
}

void add_bands(Plane<ValueSum>& plane, std::size_t i, int count, const Wavelengths& wavelengths, Spectrum radiance) {
    ValueSum* const bands = &plane[i * count];
    const float per_nm = float(count) / (kMaxWavelength - kMinWavelength);
    const Spectrum light = radiance * wavelengths.measure() * per_nm;
    for (int k = 0; k < kWavelengths; ++k) {
        const int band = int((wavelengths.nm[k] - kMinWavelength) * per_nm);
        if (fits_film(light[k])) bands[std::min(band, count - 1)].add(light[k]);
    }
}

void add_channels(Plane<ValueSum>& plane, std::size_t i, int count, Spectrum values) {
    for (int c = 0; c < count; ++c)
        if (fits_film(values[c])) plane[i * count + c].add(values[c]);
}

}  // namespace

ValueSum* Film::even_sample_sums(std::size_t i, std::uint32_t sample) {
    return of<Layer::halves>().empty() || sample % 2 ? nullptr : of<Layer::halves>()[i].own;
}

ValueSum* Film::even_sample_sums(std::size_t i, std::uint32_t sample, Layer layer) {
    return of<Layer::halves>().empty() || sample % 2 || layer != Layer::splats ? nullptr : of<Layer::halves>()[i].splats;
}

void Film::count(int x, int y, std::uint32_t sample) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    ++of<Layer::sums>()[i].count;
    if (!of<Layer::halves>().empty() && sample % 2 == 0) ++of<Layer::halves>()[i].count;
}

void Film::add(int x, int y, std::uint32_t sample, Vec3f xyz) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    CameraSums& pixel = of<Layer::sums>()[i];
    if (!add_color(pixel, even_sample_sums(i, sample), rgb_from_xyz_, xyz)) pixel.mark_bad(sample);
}

void Film::add(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived) {
    if (count_of(Layer::bands) && has_emitter_layers())   // splats and samples share the sums of bands
        return add_locked(x, y, sample, wavelengths, arrived);
    const std::int64_t i = find(x, y);
    if (i >= 0) add_arrived(i, sample, wavelengths, arrived);
}

void Film::add_locked(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    const Lock lock(of<Layer::sums>()[i].lock);
    add_arrived(i, sample, wavelengths, arrived);
}

/// The caller holds the lock of the pixel if other threads may write it.
void Film::add_arrived(std::size_t i, std::uint32_t sample, const Wavelengths& wavelengths, const CameraLight& arrived) {
    CameraSums& pixel = of<Layer::sums>()[i];
    const bool without_catchers = !count_of(Layer::catchers);
    if (!without_catchers && !add_catchers(i, wavelengths, arrived)) return pixel.mark_bad(sample);
    if (!add_light(pixel, even_sample_sums(i, sample), i, sample, wavelengths, arrived.light, without_catchers))
        return;
    if (count_of(Layer::coverage)) add_coverage(i, arrived);
    const int channels = count_of(Layer::channels);
    if (channels) add_channels(of<Layer::channels>(), i, channels, responses_.of(wavelengths, arrived.light));
}

/// Adds light of catchers. Returns false if the sample is bad. The picture over a plate is `light` + `with` - `without`, so
/// its squares go into the variance, and add_light() then adds no squares.
bool Film::add_catchers(std::size_t i, const Wavelengths& wavelengths, const CameraLight& arrived) {
    const Vec3f light = wavelengths.to_xyz(arrived.light), with = wavelengths.to_xyz(arrived.with_objects),
                without = wavelengths.to_xyz(arrived.without_objects);
    for (int k = 0; k < 3; ++k)
        if (!fits_film(light[k]) || !fits_film(with[k]) || !fits_film(without[k])) return false;
    XyzSums* const catchers = &of<Layer::catchers>()[2 * i];
    for (int k = 0; k < 3; ++k) catchers[0].xyz[k].add(with[k]), catchers[1].xyz[k].add(without[k]);
    of<Layer::sums>()[i].add_squares(rgb_from_xyz_, light + with - without);
    const int channels = count_of(Layer::channels);
    if (!channels) return true;
    add_channels(of<Layer::catcher_channels>(), 2 * i, channels, responses_.of(wavelengths, arrived.with_objects));
    add_channels(of<Layer::catcher_channels>(), 2 * i + 1, channels, responses_.of(wavelengths, arrived.without_objects));
    return true;
}

void Film::add_coverage(std::size_t i, const CameraLight& arrived) {
    CoverageSums& pixel = of<Layer::coverage>()[i];
    pixel.white += coverage_steps(arrived.white);
    pixel.covered += coverage_steps(arrived.covered);
    ObjectLists& objects = of<Layer::objects>();
    if (objects.empty()) return;
    for (const ObjectCover& c : std::span(arrived.objects.data(), arrived.object_count))
        (*objects).add(i, c.object, coverage_steps(c.covered));
}

bool Film::add_light(ColorSums& sums, ValueSum* even_sums, std::size_t i, std::uint32_t sample,
                     const Wavelengths& wavelengths, Spectrum radiance, bool squares) {
    if (!add_color(sums, even_sums, rgb_from_xyz_, wavelengths.to_xyz(radiance), squares)) {
        of<Layer::sums>()[i].mark_bad(sample);
        return false;
    }
    const int bands = count_of(Layer::bands);
    if (bands) add_bands(of<Layer::bands>(), i, bands, wavelengths, radiance);
    return true;
}

void Film::add_aov(int x, int y, std::uint32_t sample, const AovSample& aov) {
    const std::int64_t i = find(x, y);
    if (i < 0 || of<Layer::aovs>().empty()) return;
    const auto values = aov_values(aov);
    if (!std::ranges::all_of(values, fits_film)) {
        CameraSums& pixel = of<Layer::sums>()[i];
        const Lock lock(pixel.lock);
        pixel.mark_bad(sample);
        return;
    }
    AovSums& pixel = of<Layer::aovs>()[i];
    for (std::size_t k = 0; k < values.size(); ++k) pixel.sums[k].add(values[k]);
    ++pixel.passed;
    if (!aov.hit) return;
    ++pixel.hits;
    pixel.take_object(sample, aov.object_id);
}

void Film::splat(int x, int y, std::uint32_t sample, const Wavelengths& wavelengths, Spectrum radiance, Layer layer) {
    const std::int64_t i = find(x, y);
    if (i < 0) return;
    const int count = count_of(Layer::channels);
    const Spectrum channels = count ? responses_.of(wavelengths, radiance) : Spectrum();
    if (!count_of(Layer::bands)) {
        const Vec3f xyz = wavelengths.to_xyz(radiance);
        return splat_row(x, y, sample, std::span(&xyz, 1), layer, std::span(&channels, count ? 1 : 0));
    }
    Plane<ColorSums>& sums = emitter_sums(layer);
    DG_CHECK(sums.size(), >, std::size_t(i));
    {
        const Lock lock(of<Layer::sums>()[i].lock);
        if (!add_light(sums[i], even_sample_sums(i, sample, layer), i, sample, wavelengths, radiance)) return;
    }
    const Lock lock(row_lock(y));
    add_channels(of<Layer::channel_splats>(), i, count, channels);
}

void Film::splat_row(int x, int y, std::uint32_t sample, std::span<const Vec3f> xyz, Layer layer,
                     std::span<const Spectrum> channels) {
    const std::int64_t left = std::int64_t(layout_.offset_x) - x, right = left + layout_.width;
    const auto begin = std::size_t(std::max<std::int64_t>(0, left));
    const auto end = std::size_t(std::clamp<std::int64_t>(right, 0, std::int64_t(xyz.size())));
    const std::int64_t row = std::int64_t(y) - layout_.offset_y;
    if (begin >= end || row < 0 || row >= layout_.height) return;
    const std::int64_t first = row * layout_.width - left;   // index of the first pixel, which may be outside
    Plane<ColorSums>& sums = emitter_sums(layer);
    DG_CHECK(sums.size(), >=, std::size_t(first + std::int64_t(end)));
    const Lock lock(row_lock(y));
    for (std::size_t k = begin; k < end; ++k) {
        if (xyz[k] == Vec3f{0, 0, 0} && channels.empty()) continue;
        const std::size_t i = std::size_t(first + std::int64_t(k));
        if (add_color(sums[i], even_sample_sums(i, sample, layer), rgb_from_xyz_, xyz[k])) {
            if (!channels.empty())
                add_channels(of<Layer::channel_splats>(), i, count_of(Layer::channels), channels[k]);
            continue;
        }
        CameraSums& pixel = of<Layer::sums>()[i];
        const Lock of_pixel(pixel.lock);
        pixel.mark_bad(sample);
    }
}

void Film::add_flare_row(int x, int y, std::span<const FlareSteps> steps, std::span<const Int128> channels) {
    const std::int64_t first = find(x, y);
    DG_CHECK(first, >=, 0);
    Plane<ColorSums>& sums = of<Layer::flare>();
    DG_CHECK(sums.size(), >=, std::size_t(first) + steps.size());
    const Lock lock(row_lock(y));
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            sums[first + i].xyz[k].add_steps(steps[i].xyz[k]);
            sums[first + i].rgb_squares[k].add_steps(steps[i].squares[k]);
        }
    for (std::size_t i = 0; i < channels.size(); ++i)
        of<Layer::channel_splats>()[first * count_of(Layer::channels) + i].add_steps(channels[i]);
}

void Film::prefetch(int x0, int x1, int y0, int y1, Layer layer) {
    constexpr std::size_t kLine = 64;   // bytes
    const Plane<ColorSums>& sums = emitter_sums(layer);
    const int left = std::max(x0, layout_.offset_x), right = std::min(x1, layout_.offset_x + layout_.width),
              bottom = std::min(y1, layout_.offset_y + layout_.height);
    if (left >= right || sums.empty()) return;
    for (int y = std::max(y0, layout_.offset_y); y < bottom; ++y) {
        const char* const row = reinterpret_cast<const char*>(sums.data() + find(left, y));
        for (std::size_t at = 0; at < std::size_t(right - left) * sizeof(ColorSums); at += kLine)
            __builtin_prefetch(row + at, 1);
    }
}

}  // namespace dg
