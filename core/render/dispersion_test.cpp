#include "render/dispersion.h"

#include <doctest/doctest.h>

#include "math/hash.h"

namespace dg {
namespace {

/// Samples per pixel of a round that skips pixels.
std::vector<std::uint32_t> patchy(int pixels) {
    std::vector<std::uint32_t> counts;
    for (int i = 0; i < pixels; ++i)
        counts.push_back(std::array{0u, 4u, 8u, 32u}[int(4 * hash_uniform(3, i))]);
    return counts;
}

/// Simulates a lossless lens that shifts each wavelength by a different amount. For every round, each wavelength must
/// add n(p) to pixel p on average; in a world with luminance proportional to time, the mean over the exposure of the
/// pixel's line. Returns the largest |z| over pixels and wavelengths.
double largest_deviation(const Filter& filter, const std::vector<std::uint32_t>& counts,
                         std::span<const std::uint32_t> told, const Shutter& shutter = {},
                         bool told_shutter = true) {
    const Sensor sensor{8, 6, 8, 6, {0, 0}};
    const FilmLayout region{8, 6, 0, 0};
    const FilmDensity density(filter, region, told, told_shutter ? &shutter : nullptr);
    const bool brightens = shutter.duration_s() > 0;
    const std::array<Vec2f, kWavelengths> shift{Vec2f{0, 0}, {0.7f, 0.2f}, {-0.5f, 0.4f}, {1.6f, -1.3f}};
    std::vector<double> sums(48 * kWavelengths), squares(sums);
    const int rounds = 400;
    std::uint64_t draw = 0;
    const auto u = [&] { return float(hash_uniform(5, draw++)); };
    for (int round = 0; round < rounds; ++round)
        for (int p = 0; p < 48; ++p)
            for (std::uint32_t i = 0; i < counts[p]; ++i) {
                const Pixel pixel{p % 8, p / 8};
                const int first = int(4 * u());
                const float time = shutter.draw(pixel.x, pixel.y, u()).time;
                const Vec2f f = filter.sample({u(), u()}).offset;
                const Vec2f px{pixel.x + 0.5f + f.x, pixel.y + 0.5f + f.y};
                std::array<Reprojection, kWavelengths - 1> others;
                for (int k = 1; k < kWavelengths; ++k) {
                    const Vec2f to = shift[(first + k) % 4], from = shift[first];
                    const Vec2f there{px.x + to.x - from.x, px.y + to.y - from.y};
                    others[k - 1] = {sensor.mm_from_px(there), 1, 1};
                }
                const auto landings = land(density, sensor, {px, pixel, time, 1, 1}, others, u());
                for (const Landing& landing : landings)
                    for (int k = 0; k < kWavelengths; ++k) {
                        const Pixel at = landing.pixel;
                        const std::size_t place = (at.y * 8 + at.x) * 4 + (first + k) % 4;
                        const float w = landing.weight[k] * (brightens ? time : 1);
                        sums[place] += w;
                        squares[place] += w * w;
                    }
            }
    double largest = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const int pixel = int(i / 4);
        // The opening curve is symmetric, so its mean time is the middle of the window.
        const double seen = brightens ? shutter.draw(pixel % 8, pixel / 8, 0.5f).time : 1;
        const double expected = rounds * counts[pixel] * seen * shutter.weight();
        const double sigma = std::sqrt(squares[i]);   // sum of independent arrivals
        largest = std::max(largest, std::abs(sums[i] - expected) / std::max(sigma, 1e-9));
    }
    return largest;
}

}  // namespace

TEST_CASE("each wavelength brings every pixel what the filter has there") {
    const std::vector<std::uint32_t> even(48, 8);
    for (const FilterKind kind : {FilterKind::box, FilterKind::gaussian, FilterKind::blackman_harris,
                                  FilterKind::mitchell, FilterKind::tent}) {
        const Filter filter(kind);
        CHECK(largest_deviation(filter, even, {}) < 5);   // of 192
    }
}

TEST_CASE("where pixels get different numbers of samples, so do the landings") {
    const auto counts = patchy(48);
    for (const FilterKind kind : {FilterKind::box, FilterKind::gaussian, FilterKind::mitchell}) {
        const Filter filter(kind);
        CHECK(largest_deviation(filter, counts, counts) < 5);    // of 192
        CHECK(largest_deviation(filter, counts, {}) > 50);       // planted fault: densities without the counts
    }
}

TEST_CASE("wavelengths land on lines that are open then, in proportion to how far") {
    ShutterSettings settings;
    settings.curve = OpeningCurve::trapezoid(0.7);
    settings.exposure_s = 2, settings.line_time_s = 1;   // two or three lines are open at a time
    const std::vector<std::uint32_t> even(48, 8);
    const auto counts = patchy(48);
    for (const ScanOrder scan : {ScanOrder::none, ScanOrder::top, ScanOrder::bottom, ScanOrder::right}) {
        settings.scan = scan;
        const Shutter shutter(settings, 8, 6);
        for (const FilterKind kind : {FilterKind::box, FilterKind::mitchell}) {
            const Filter filter(kind);
            CHECK(largest_deviation(filter, even, {}, shutter) < 5);   // of 192
            CHECK(largest_deviation(filter, counts, counts, shutter) < 5);
            if (scan != ScanOrder::none)   // planted fault: densities without the shutter of lines
                CHECK(largest_deviation(filter, even, {}, shutter, false) > 10);
        }
    }
}

TEST_CASE("without dispersion all four wavelengths keep the pixel and the plain weight") {
    const Sensor sensor{8, 6, 8, 6, {0, 0}};
    const FilmLayout region{8, 6, 0, 0};
    for (const FilterKind kind : {FilterKind::box, FilterKind::mitchell}) {
        const Filter filter(kind);
        const FilmDensity density(filter, region);
        const Vec2f px{4.4f, 3.3f};
        const Hero hero{px, {4, 3}, 0, 0.6f, 0.8f};
        const Reprojection same{sensor.mm_from_px(px), 0.75f, 0.8f};
        const std::array<Reprojection, 3> others{same, same, same};
        const Landings landings = land(density, sensor, hero, others, 0.999f);
        CHECK(landings.end() - landings.begin() == 1);
        const Landing& l = *landings.begin();
        CHECK(l.pixel == Pixel{4, 3});
        for (int k = 0; k < kWavelengths; ++k)
            CHECK(l.weight[k] == doctest::Approx(0.6 * filter.absolute_integral()).epsilon(1e-4));
    }
}

TEST_CASE("a wavelength that the lens stops brings nothing and takes nothing") {
    const Sensor sensor{8, 6, 8, 6, {0, 0}};
    const FilmLayout region{8, 6, 0, 0};
    const Filter filter(FilterKind::box);
    const FilmDensity density(filter, region);
    const Hero hero{{4.4f, 3.3f}, {4, 3}, 0, 0.8f, 0.8f};
    const auto landings = land(density, sensor, hero, std::array<Reprojection, 3>{}, 0.5f);
    // Only the hero could have drawn the ray, with probability 1/4.
    CHECK(landings.end() - landings.begin() == 1);
    CHECK(landings.begin()->weight[0] == doctest::Approx(4 * 0.8));
    for (int i = 1; i < kWavelengths; ++i) CHECK(landings.begin()->weight[i] == 0);
}

}  // namespace dg
