#include "render/drawn_samples.h"

#include <algorithm>
#include <functional>

namespace dg {
namespace {

FilmLayout cut(FilmLayout region, const PixelBox& window) {
    if (window.empty()) return region;
    const int x0 = std::max(region.offset_x, window.x0), x1 = std::min(region.offset_x + region.width, window.x1),
              y0 = std::max(region.offset_y, window.y0), y1 = std::min(region.offset_y + region.height, window.y1);
    region.offset_x = x0, region.offset_y = y0;
    region.width = std::max(0, x1 - x0), region.height = std::max(0, y1 - y0);
    return region;
}

std::size_t index_in(const FilmLayout& film, Pixel p) {
    return std::size_t(p.y - film.offset_y) * film.width + std::size_t(p.x - film.offset_x);
}

/// Calls use(pixel, index in the film) for the pixels of a region outside the hole.
template <typename Use>
void for_each_drawn(const FilmLayout& region, const FilmLayout& film, const PixelBox& hole, const Use& use) {
    for (int y = region.offset_y; y < region.offset_y + region.height; ++y)
        for (int x = region.offset_x; x < region.offset_x + region.width; ++x)
            if (!hole.contains(x, y)) use(Pixel{x, y}, index_in(film, {x, y}));
}

/// Number of samples of each pixel of the region, if they differ: from a round, or 1 and 0 for a region with a hole.
std::vector<std::uint32_t> counts_of(const RenderSettings& settings, const FilmLayout& region,
                                     const FilmLayout& film) {
    const SampleRound& round = settings.round;
    if (round.count.empty() && settings.hole.empty()) return {};
    std::vector<std::uint32_t> counts(std::size_t(region.width) * region.height);
    for_each_drawn(region, film, settings.hole, [&](Pixel p, std::size_t i) {
        counts[index_in(region, p)] = round.count.empty() ? 1 : round.count[i];
    });
    const bool even = std::ranges::adjacent_find(counts, std::not_equal_to<>{}) == counts.end();
    return even ? std::vector<std::uint32_t>{} : counts;
}

/// Sums of a round over the pixels that are drawn.
struct RoundSums {
    UInt128 begin = 0, count = 0;
    std::size_t pixels = 0;
    RoundSums(const RenderSettings& settings, const FilmLayout& region, const FilmLayout& film) {
        for_each_drawn(region, film, settings.hole, [&](Pixel, std::size_t i) {
            begin += settings.round.begin[i], count += settings.round.count[i], ++pixels;
        });
    }
    double mean_count() const { return double(count) / double(pixels); }
    /// Mean sample index before a part. Bit-identical at the end of a round and at the beginning of the next.
    double until(std::uint32_t part) const {
        return double(begin * SampleRound::kParts + count * part) / (double(pixels) * SampleRound::kParts);
    }
};

}  // namespace

DrawnSamples::DrawnSamples(const RenderSettings& settings, const FilmLayout& film)
    : settings_(settings), film_(film), region_(cut(film, settings.window)),
      counts_(counts_of(settings, region_, film)) {}

std::array<std::uint32_t, 2> DrawnSamples::of(Pixel pixel) const {
    if (settings_.hole.contains(pixel.x, pixel.y)) return {0, 0};
    if (settings_.round.count.empty()) return {settings_.sample_begin, settings_.sample_end};
    return settings_.round.samples(index_in(film_, pixel));
}

double DrawnSamples::per_count() const {
    if (counts_.empty() || settings_.round.count.empty()) return 1;
    return RoundSums(settings_, region_, film_).mean_count();
}

std::array<double, 2> DrawnSamples::indices() const {
    const SampleRound& round = settings_.round;
    if (round.count.empty()) return {double(settings_.sample_begin), double(settings_.sample_end)};
    const RoundSums sums(settings_, region_, film_);
    return {sums.until(round.first), sums.until(round.last)};
}

}  // namespace dg
