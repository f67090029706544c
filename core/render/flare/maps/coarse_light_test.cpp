#include "render/flare/maps/coarse_light.h"

#include <doctest/doctest.h>

#include "math/sampler.h"

using namespace dg;

namespace {

constexpr int kWide = 96, kHigh = 80;
constexpr double kFilter = 0.15;   // px2
const FilmLayout kFrame{.width = kWide, .height = kHigh, .layers = {Layer::flare}};

struct Drawn {
    Film film;
    explicit Drawn(FilmLayout layout = {.width = kWide, .height = kHigh, .layers = {Layer::flare}}) : film(layout) {
        for (int y = layout.offset_y; y < layout.offset_y + layout.height; ++y)
            for (int x = layout.offset_x; x < layout.offset_x + layout.width; ++x) film.count(x, y);
    }
    void take(const CoarseLight& light) {
        const Filter filter;
        const FilmLayout& l = film.layout();
        light.to_film(film, FilmDensity(filter, l), l.offset_y, l.offset_y + l.height);
    }
    float y(int px, int py) const {
        const FilmLayout& l = film.layout();
        return film.means("flare")[3 * (std::size_t(py - l.offset_y) * l.width + px - l.offset_x) + 1];
    }
};

void add(CoarseLight& light, Vec2f px, float v) {
    const CoarseLight::Arrival one{px, {v, v, v}};
    light.add({&one, 1});
}

/// Adds lights of different kinds inside and around the frame.
void scatter(CoarseLight& light, int first, int last) {
    for (int i = first; i < last; ++i) {
        PathSampler sampler(3, 4, std::uint32_t(i), 5);
        const CameraRandom u = sampler.camera();
        add(light, {u.film.x * (kWide + 20) - 10, u.film.y * (kHigh + 20) - 10}, u.time * u.time);
    }
}

}  // namespace

TEST_CASE("light on coarse nodes comes to the pixels whole, where it was, and as wide as its kernel") {
    for (int level = 0; level <= 4; ++level) {
        CoarseLight light(kFrame, 3, level, 0.01, kFilter);
        const Vec2f at{47.3f, 41.8f};
        add(light, at, 5);
        Drawn drawn;
        drawn.take(light);
        double sum = 0, x = 0, y = 0, wide = 0;
        for (int py = 0; py < kHigh; ++py)
            for (int px = 0; px < kWide; ++px) {
                const double v = drawn.y(px, py);
                sum += v, x += v * (px + 0.5), y += v * (py + 0.5), wide += v * (px + 0.5 - at.x) * (px + 0.5 - at.x);
            }
        CHECK(sum == doctest::Approx(5).epsilon(1e-5));
        CHECK(x / sum == doctest::Approx(at.x).epsilon(1e-5));
        CHECK(y / sum == doctest::Approx(at.y).epsilon(1e-5));
        // Two nodes, resampled by the spline; on level 0, by weights that give the filter on average.
        const double p = 1 << level, shift = level == 0 ? 0.5 : 0, f = at.x / p - shift - std::floor(at.x / p - shift);
        const double spline = level == 0 ? kFilter - 1 / 6.0 : 0.25;
        CHECK(wide / sum == doctest::Approx(p * p * (f * (1 - f) + spline)).epsilon(0.02));
    }
}

TEST_CASE("even light on coarse nodes is even on pixels") {
    CoarseLight light(kFrame, 5, 3, 0.2, kFilter);
    for (int y = -32; y < kHigh + 32; ++y)
        for (int x = -32; x < kWide + 32; ++x) {
            const CoarseLight::Arrival one{{float(x), float(y)}, {0.2f, 0.2f, 0.2f, 0.1f, 0.3f}};
            light.add({&one, 1});
        }
    Drawn drawn;
    drawn.film = Film({.width = kWide, .height = kHigh, .layers = {Layer::flare, {Layer::channels, 2}}});
    drawn.take(light);
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x) drawn.film.count(x, y);
    for (const float v : drawn.film.means("flare")) CHECK(v == doctest::Approx(0.2).epsilon(1e-5));
    const std::vector<float> channels = drawn.film.mean_channels();
    CHECK(channels[100] == doctest::Approx(0.1).epsilon(1e-5));
    CHECK(channels[101] == doctest::Approx(0.3).epsilon(1e-5));
}

TEST_CASE("coarse light has the same bits in parts, in any order, and in a crop") {
    CoarseLight whole(kFrame, 3, 2, 1e-4, kFilter), first(kFrame, 3, 2, 1e-4, kFilter), second(kFrame, 3, 2, 1e-4, kFilter),
        backward(kFrame, 3, 2, 1e-4, kFilter);
    scatter(whole, 0, 500), scatter(first, 0, 200), scatter(second, 200, 500);
    scatter(backward, 200, 500), scatter(backward, 0, 200);
    const FilmLayout part{.width = 20, .height = 12, .offset_x = 31, .offset_y = 17, .layers = {Layer::flare}};
    CoarseLight cut(part, 3, 2, 1e-4, kFilter);
    scatter(cut, 0, 500);
    Drawn one, apart, turned, crop(part);
    one.take(whole), apart.take(first), apart.take(second), turned.take(backward), crop.take(cut);
    CHECK(one.film.means("flare") == apart.film.means("flare"));
    CHECK(one.film.means("flare") == turned.film.means("flare"));
    for (const char* name : {"flare"}) {
        CHECK(std::ranges::equal(one.film.state(name).bytes, apart.film.state(name).bytes));
        CHECK(std::ranges::equal(one.film.state(name).bytes, turned.film.state(name).bytes));
    }
    for (int y = part.offset_y; y < part.offset_y + part.height; ++y)
        for (int x = part.offset_x; x < part.offset_x + part.width; ++x) CHECK(crop.y(x, y) == one.y(x, y));
}

TEST_CASE("coarse light of a thousandth of the mean keeps its sum, and its squares tell its variance") {
    CoarseLight light(kFrame, 3, 4, 1e6, kFilter);
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
        PathSampler sampler(1, 1, std::uint32_t(i), 1);
        const Vec2f u = sampler.camera().film;
        add(light, {40 + u.x, 48 + u.y}, 1e3f);
    }
    Drawn drawn;
    drawn.take(light);
    double sum = 0;
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x) sum += drawn.y(x, y);
    CHECK(sum == doctest::Approx(1e3 * kCount).epsilon(1e-3));

    // Many arrivals: the film's variance estimate agrees with the variance of pixel values.
    constexpr int kPictures = 400, kLights = 60, kX = 33, kY = 20;
    double mean = 0, squares = 0, told = 0;
    for (int k = 0; k < kPictures; ++k) {
        CoarseLight one(kFrame, 3, 3, 0.01, kFilter);
        for (int i = 0; i < kLights; ++i) {
            const std::uint64_t h = hash64(std::uint64_t(k) + 1, std::uint64_t(i));
            const float x = unit_float(std::uint32_t(h)), y = unit_float(std::uint32_t(h >> 32));
            add(one, {x * 200 - 65, y * 200 - 80}, 1);
        }
        Drawn picture;
        picture.take(one);
        const double v = picture.y(kX, kY);
        mean += v / kPictures, squares += v * v / kPictures;
        told += double(picture.film.variance_rgb()[3 * (std::size_t(kY) * kWide + kX) + 1]) / kPictures;
    }
    const double variance = squares - mean * mean;   // slightly low, as the number of lights is fixed
    CHECK(told == doctest::Approx(variance).epsilon(0.25));
}
