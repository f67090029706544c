#include "render/drawn_samples.h"

#include <doctest/doctest.h>

#include "render/tiles.h"

namespace dg {
namespace {

constexpr FilmLayout kFilm{.width = 5, .height = 4, .offset_x = 10, .offset_y = 20};

/// Sample ranges of a call, for each pixel of the film.
std::vector<std::array<std::uint32_t, 2>> drawn(const RenderSettings& settings) {
    const DrawnSamples samples(settings, kFilm);
    std::vector<std::array<std::uint32_t, 2>> all(20);
    const Tiles tiles(samples.region());
    for (std::uint64_t t = 0; t < tiles.count(); ++t)
        for (int y = tiles[t].y0; y < tiles[t].y1; ++y)
            for (int x = tiles[t].x0; x < tiles[t].x1; ++x)
                all[std::size_t(y - 20) * 5 + std::size_t(x - 10)] = samples.of({x, y});
    return all;
}

}  // namespace

TEST_CASE("tiles cover a region once") {
    const FilmLayout region{.width = 35, .height = 17, .offset_x = -3, .offset_y = 2};
    const Tiles tiles(region);
    CHECK(tiles.count() == 6);
    std::vector<int> covered(35 * 17);
    for (std::uint64_t t = 0; t < tiles.count(); ++t)
        for (int y = tiles[t].y0; y < tiles[t].y1; ++y)
            for (int x = tiles[t].x0; x < tiles[t].x1; ++x) ++covered.at(std::size_t(y - 2) * 35 + std::size_t(x + 3));
    CHECK(covered == std::vector<int>(35 * 17, 1));
    CHECK(Tiles(FilmLayout{.width = 0, .height = 0}).count() == 0);
}

TEST_CASE("a window and a hole leave the pixels between") {
    RenderSettings s;
    s.sample_begin = 3, s.sample_end = 8;
    s.window = {11, 20, 14, 23}, s.hole = {12, 21, 13, 22};
    const auto all = drawn(s);
    for (int i = 0; i < 20; ++i) {
        const int x = 10 + i % 5, y = 20 + i / 5;
        const bool wanted = x >= 11 && x < 14 && y < 23 && !(x == 12 && y == 21);
        CHECK(all[std::size_t(i)] == (wanted ? std::array{3u, 8u} : std::array{0u, 0u}));
    }
    const DrawnSamples samples(s, kFilm);
    CHECK(samples.region().width == 3);
    CHECK(samples.region().height == 3);
    REQUIRE(samples.counts().size() == 9);   // no samples in the hole, so densities differ
    CHECK(samples.counts()[4] == 0);
    CHECK(samples.counts()[0] == 1);
    CHECK(samples.per_count() == 1);
    CHECK(samples.indices() == std::array{3.0, 8.0});
}

TEST_CASE("counts that are all alike need no weighing") {
    RenderSettings s;
    CHECK(DrawnSamples(s, kFilm).counts().empty());
    const std::vector<std::uint32_t> begin(20, 4), count(20, 6);
    s.round = {begin, count};
    const DrawnSamples even(s, kFilm);
    CHECK(even.counts().empty());
    CHECK(even.per_count() == 1);
    CHECK(even.indices() == std::array{4.0, 10.0});
}

TEST_CASE("parts of a round are the round, and paths go on where the last part ended") {
    std::vector<std::uint32_t> begin(20), count(20);
    for (std::uint32_t i = 0; i < 20; ++i) begin[i] = 2 * i, count[i] = (i * i) % 7;
    RenderSettings s;
    s.round = {begin, count};
    const auto whole = drawn(s);
    double mean_begin = 0, mean_count = 0;
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(whole[i] == std::array{begin[i], begin[i] + count[i]});
        mean_begin += begin[i] / 20.0, mean_count += count[i] / 20.0;
    }
    CHECK(DrawnSamples(s, kFilm).counts().size() == 20);
    CHECK(DrawnSamples(s, kFilm).per_count() == doctest::Approx(mean_count));
    CHECK(DrawnSamples(s, kFilm).indices()[0] == doctest::Approx(mean_begin));
    CHECK(DrawnSamples(s, kFilm).indices()[1] == doctest::Approx(mean_begin + mean_count));
    RenderSettings a = s, b = s;
    a.round.last = b.round.first = 20000;
    const auto first = drawn(a), second = drawn(b);
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(first[i][0] == whole[i][0]);
        CHECK(first[i][1] == second[i][0]);
        CHECK(second[i][1] == whole[i][1]);
    }
    CHECK(DrawnSamples(a, kFilm).indices()[1] == DrawnSamples(b, kFilm).indices()[0]);   // bit-identical
}

}  // namespace dg
