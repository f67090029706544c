// film_test.cpp -- exactness in any order, state round trip, variance, bad samples, AOVs.
#include "film/film.h"

#include <doctest/doctest.h>

#include <thread>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "film/kept_films.h"
#include "film/word_columns.h"
#include "math/error.h"
#include "math/hash.h"
#include "math/statistics.h"
#include "spectrum/wavelengths.h"

using namespace dg;

namespace {

constexpr int kWidth = 5, kHeight = 4, kPerPixel = 40;
constexpr FilmLayout kLayout{kWidth, kHeight, 10, 20, {Layer::aovs}};

/// Values over many orders of magnitude that are no sums of powers of two; some negative,
/// some bad.
Vec3f value(int i) {
    if (i % 97 == 5) return {std::numeric_limits<float>::quiet_NaN(), 1, 1};
    const auto one = [&](int k) {
        const double size = std::exp(60 * hash_uniform(k, i) - 35);
        return float(hash_uniform(k + 10, i) < 0.2 ? -size : size);
    };
    return {one(1), one(2), one(3)};
}

struct Draw {
    int x, y;
    std::uint32_t sample;
    int id;
};

std::vector<Draw> all_draws() {
    std::vector<Draw> draws;
    for (int p = 0; p < kWidth * kHeight; ++p)
        for (int s = 0; s < kPerPixel; ++s)
            draws.push_back(
                {10 + p % kWidth, 20 + p / kWidth, std::uint32_t(s), p * kPerPixel + s});
    return draws;
}

void shuffle(std::vector<Draw>& draws, std::uint64_t seed) {
    std::sort(draws.begin(), draws.end(), [&](const Draw& a, const Draw& b) {
        return hash64(seed, a.id) < hash64(seed, b.id);
    });
}

void draw(Film& film, const Draw& d) {
    film.add(d.x, d.y, d.sample, value(d.id));
    film.count(d.x, d.y);
    if (d.id % 3 == 0) return;  // vignetted: brings no auxiliary values
    const Vec3f v{float(d.id) * 0.1f, std::exp(float(d.id % 17)), -1.f / float(d.id + 1)};
    film.add_aov(d.x, d.y, d.sample,
                 {d.id % 4 != 0, v.y, v, normalize(v), v, std::uint32_t(d.id), 0.3f});
}

void splat(Film& film, int x, int y, std::uint32_t sample, Vec3f xyz, Layer layer = Layer::splats) {
    film.splat_row(x, y, sample, std::span(&xyz, 1), layer);
}

/// The values of a draw as light, which comes in wavelengths.
CameraLight light_of(const Draw& d) {
    const Vec3f v = value(d.id);
    return {.light = Spectrum(v.x, v.y, v.z, v.x)};
}

std::vector<std::byte> whole_state(const Film& film) {
    std::vector<std::byte> all;
    for (const std::string& part : film.state_parts()) {
        const LayerState state = film.state(part);
        all.insert(all.end(), state.bytes.begin(), state.bytes.end());
    }
    return all;
}

}  // namespace

TEST_CASE("any order and any split with any order of merging give the same bits") {
    std::vector<Draw> draws = all_draws();
    Film whole(kLayout);
    for (const Draw& d : draws) draw(whole, d);
    const auto expected = whole_state(whole);
    for (int trial = 0; trial < 20; ++trial) {
        shuffle(draws, trial);
        const int parts = 1 + trial % 7;
        std::vector<Film> films;
        for (int p = 0; p < parts; ++p) films.emplace_back(kLayout);
        for (std::size_t i = 0; i < draws.size(); ++i)
            draw(films[hash64(trial, i) % parts], draws[i]);
        Film merged(kLayout);
        for (int p = 0; p < parts; ++p) merged.merge(films[(p + trial) % parts]);
        CHECK(whole_state(merged) == expected);
        CHECK(merged.mean_xyz() == whole.mean_xyz());
        CHECK(merged.variance_rgb() == whole.variance_rgb());
        CHECK(merged.bad_sample_count() == whole.bad_sample_count());
    }
    // Float sums would not have passed: forward and backward they differ.
    float forward = 0, backward = 0;
    for (int i = 0; i < 1000; ++i) forward += float(hash_uniform(3, i));
    for (int i = 999; i >= 0; --i) backward += float(hash_uniform(3, i));
    CHECK(forward != backward);
    Film changed(kLayout);
    for (const Draw& d : draws) draw(changed, d);
    changed.add(12, 21, 0, {0, 1e-12f, 0});
    CHECK(whole_state(changed) != expected);
}

TEST_CASE("shared adding: from several threads, in any order, the bits of adding alone") {
    std::vector<Draw> draws = all_draws();
    Film direct(kLayout), shared(kLayout);
    const Wavelengths w = Wavelengths::sample(0.4f);
    for (const Draw& d : draws) direct.add(d.x, d.y, d.sample, w, light_of(d));
    shuffle(draws, 5);
    const auto add_third = [&](std::size_t first) {
        for (std::size_t i = first; i < draws.size(); i += 3)
            shared.add_locked(draws[i].x, draws[i].y, draws[i].sample, w, light_of(draws[i]));
        shared.add_locked(0, 0, 0, w, {.light = 1.f});  // outside the region: ignored
    };
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < 3; ++k) threads.emplace_back(add_third, k);
    for (std::thread& t : threads) t.join();
    CHECK(whole_state(direct) == whole_state(shared));
    CHECK(direct.bad_samples().size() == shared.bad_samples().size());
}

TEST_CASE("the state comes back bit for bit") {
    Film film(kLayout), copy(kLayout);
    for (const Draw& d : all_draws()) draw(film, d);
    for (const std::string& part : film.state_parts())
        copy.set_state(part, film.state(part).bytes);
    CHECK(whole_state(copy) == whole_state(film));
    CHECK(copy.mean_xyz() == film.mean_xyz());
    CHECK(copy.aov("P.Y") == film.aov("P.Y"));
    CHECK(copy.object_ids() == film.object_ids());
    CHECK(copy.bad_samples()[0].sample == film.bad_samples()[0].sample);
    CHECK(copy.sample_counts() == film.sample_counts());
    CHECK_THROWS_AS(film.state("sum.Q.0").bytes, Error);
    CHECK_THROWS_AS(film.set_state("sums", film.state("aovs").bytes), Error);
    const Film bare(FilmLayout{2, 2, 0, 0});
    CHECK_THROWS_AS(bare.state("aovs").bytes, Error);
    CHECK(bare.state("sums").bytes.size() == 4 * 112);
}

TEST_CASE("a fixed sum is exact where a double is not") {
    ValueSum a, b;
    a.add(1099511627775.0);
    a.add(0x1p-63);
    a.add(-1099511627775.0);
    CHECK(a.value() == 0x1p-63);
    for (int i = 0; i < 1000; ++i) {
        b.add(0.1f);
        b.add(-0.7e-9f);
    }
    CHECK(b.value() == 1000 * (double(0.1f) - double(0.7e-9f)));
    SquareSum c;
    c.add(kMaxFilmSquare);
    c.add(0x1p-43);
    c.add(0x1p-44);  // below a step: 0
    c.add(-kMaxFilmSquare);
    CHECK(c.value() == 0x1p-43);
}

TEST_CASE(
    "mean and variance against two passes in double, and the spread of many films") {
    const int n = 64, films = 400;
    std::vector<double> means, variances;
    for (int f = 0; f < films; ++f) {
        Film film(FilmLayout{1, 1, 0, 0});
        std::vector<double> green;
        for (int i = 0; i < n; ++i) {
            const Rgb rgb{1, float(2 * hash_uniform(f, i)), 0.5f};
            film.add(0, 0, i, xyz_from_rgb(rgb));
            film.count(0, 0);
            green.push_back(rgb.y);
        }
        const SampleMoments m = moments(green);
        const std::vector<float> v = film.variance_rgb();
        REQUIRE(v[1] / (m.variance / n) == doctest::Approx(1).epsilon(1e-4));
        REQUIRE(v[0] < 1e-9);
        const std::vector<float> xyz = film.mean_xyz();
        REQUIRE(rgb_from_xyz({xyz[0], xyz[1], xyz[2]}).y ==
                doctest::Approx(m.mean).epsilon(1e-5));
        means.push_back(m.mean);
        variances.push_back(v[1]);
    }
    CHECK(moments(variances).mean / moments(means).variance ==
          doctest::Approx(1).epsilon(0.08));
    Film one(FilmLayout{1, 1, 0, 0});
    CHECK(one.mean_xyz()[0] == 0);
    one.add(0, 0, 0, {1, 1, 1});
    one.count(0, 0);
    CHECK(one.variance_rgb()[0] == 0);
}

TEST_CASE("variance where wavelengths of other samples land: a pixel that also receives random arrivals") {
    const int n = 64, films = 600;
    std::vector<double> means, variances;
    for (int f = 0; f < films; ++f) {
        Film film(FilmLayout{1, 1, 0, 0});
        for (int i = 0; i < n; ++i) {
            film.count(0, 0);
            if (hash_uniform(f, i) < 0.3) film.add(0, 0, i, xyz_from_rgb({1, 1, 1}));
            if (hash_uniform(f + 9999, i) < 0.2)
                film.add(0, 0, i, xyz_from_rgb({2, 2, 2}));
        }
        const std::vector<float> xyz = film.mean_xyz();
        means.push_back(xyz[1]);
        variances.push_back(film.variance_rgb()[1]);
    }
    CHECK(moments(means).mean == doctest::Approx(0.7).epsilon(0.02));
    // Own samples 0.3 - 0.09, arrivals 0.8 - 0.16; the film knows 1.1 and the mean, 0.7, alone.
    CHECK(n * moments(means).variance == doctest::Approx(0.85).epsilon(0.06));
    CHECK(n * moments(variances).mean == doctest::Approx(1.1 - 0.49).epsilon(0.03));
}

TEST_CASE("splats: means have the same divisor, variances know that arrivals are independent") {
    const int n = 64, films = 600;
    std::vector<double> means, variances;
    for (int f = 0; f < films; ++f) {
        Film film(FilmLayout{1, 1, 0, 0, {Layer::splats}});
        for (int i = 0; i < n; ++i) {
            film.count(0, 0);
            if (hash_uniform(f, i) < 0.3) film.add(0, 0, i, xyz_from_rgb({1, 1, 1}));
            for (int k = 0; k < 8; ++k)   // eight light paths per sample, few of which come here
                if (hash_uniform(f + 9999, 8 * i + k) < 0.05)
                    splat(film, 0, 0, i, xyz_from_rgb({2, 2, 2}));
        }
        means.push_back(film.mean_xyz()[1]);
        variances.push_back(film.variance_rgb()[1]);
    }
    CHECK(moments(means).mean == doctest::Approx(0.3 + 0.8).epsilon(0.02));
    // Own samples 0.3 - 0.09; arrivals 8 x 4 x 0.05 x (1 - 0.05), of which the film takes the last as 1.
    CHECK(n * moments(means).variance == doctest::Approx(0.21 + 1.52).epsilon(0.12));
    CHECK(n * moments(variances).mean == doctest::Approx(0.21 + 1.6).epsilon(0.03));
}

TEST_CASE("splats: the same bits in any order, from any thread and any split; none where there are none") {
    const FilmLayout layout{kWidth, kHeight, 10, 20, {Layer::splats}};
    Film whole(layout), split(layout), part(layout);
    std::vector<Draw> draws = all_draws();
    for (const Draw& d : draws) splat(whole, d.x, d.y, d.sample, value(d.id));
    shuffle(draws, 3);
    const std::size_t half = draws.size() / 2;
    std::thread other([&] {
        for (std::size_t i = 0; i < half; ++i)
            splat(split, draws[i].x, draws[i].y, draws[i].sample, value(draws[i].id));
    });
    for (std::size_t i = half; i < draws.size(); ++i) {
        Film& film = i % 2 ? split : part;
        splat(film, draws[i].x, draws[i].y, draws[i].sample, value(draws[i].id));
    }
    other.join();
    split.merge(part);
    for (const std::string& name : whole.state_parts())
        CHECK(std::ranges::equal(whole.state(name).bytes, split.state(name).bytes));
    Film again(layout);
    again.set_state("splats", whole.state("splats").bytes);
    CHECK(std::ranges::equal(whole.state("splats").bytes, again.state("splats").bytes));
    CHECK(whole.state("splats").bytes.size() == 96 * kWidth * kHeight);

    // Ghosts are a layer of their own, and part of the picture.
    const FilmLayout lit{.width = 1, .height = 1, .layers = {Layer::splats, Layer::flare}};
    Film film(lit), more(lit);
    film.count(0, 0), more.count(0, 0);
    film.add(0, 0, 0, {1, 1, 1}), splat(film, 0, 0, 0, {2, 2, 2});
    splat(more, 0, 0, 1, {4, 6, 8}, Layer::flare);
    film.merge(more);
    CHECK(film.means("flare") == std::vector<float>{2, 3, 4});
    CHECK(film.mean_xyz() == std::vector<float>{3.5f, 4.5f, 5.5f});
    CHECK(film.state_parts() == std::vector<std::string>{"sums", "splats", "flare"});

    const Film bare(FilmLayout{2, 2, 0, 0});
    CHECK_THROWS_AS(bare.means("flare"), Error);
    CHECK(bare.state_parts() == std::vector<std::string>{"sums"});
    CHECK_THROWS_AS(bare.state("splats").bytes, Error);
    CHECK_THROWS_AS(whole.merge(Film(FilmLayout{kWidth, kHeight, 10, 20})), Error);
}

TEST_CASE("NaN, infinity and monsters are dropped, counted and found again") {
    const float inf = std::numeric_limits<float>::infinity();
    Film film(FilmLayout{4, 3, 100, 200, {Layer::aovs}});
    film.add(101, 201, 9, {1, 2, 3});
    film.add(101, 201, 8, {1, inf, 3});
    film.add(101, 201, 7, {1, 2, std::nanf("")});
    film.add(103, 200, 4, {0x1p41f, 0, 0});
    film.add(103, 200, 5, {-0x1p41f, 0, 0});
    film.add_aov(100, 202, 2, {true, 1, {inf, 0, 0}, {0, 0, 1}, {}, 3, 1});
    film.add(99, 201, 1, {inf, 0, 0});  // outside: not ours
    CHECK(film.bad_sample_count() == 6 - 1);
    const std::vector<BadSample> bad = film.bad_samples();
    REQUIRE(bad.size() == 3);
    CHECK((bad[0].x == 103 && bad[0].y == 200 && bad[0].sample == 4));
    CHECK((bad[1].x == 101 && bad[1].y == 201 && bad[1].sample == 7));
    CHECK((bad[2].x == 100 && bad[2].y == 202 && bad[2].sample == 2));
    film.count(101, 201);
    CHECK(film.mean_xyz()[3 * 5 + 1] == 2);
    Film many(FilmLayout{20, 20, 0, 0});
    for (int i = 0; i < 400; ++i) many.add(i % 20, i / 20, 3, {inf, 0, 0});
    CHECK(many.bad_sample_count() == 400);
    CHECK(many.bad_samples().size() == 100);
}

TEST_CASE("the largest values neither overflow nor disturb") {
    Film film(FilmLayout{1, 1, 0, 0});
    for (int i = 0; i < 1000; ++i) {
        film.add(0, 0, i, {kMaxFilmValue, kMaxFilmValue, kMaxFilmValue});
        film.count(0, 0);
    }
    CHECK(film.bad_sample_count() == 0);
    CHECK(film.mean_xyz()[0] == kMaxFilmValue);
    CHECK(film.variance_rgb()[0] >= 0);
}

TEST_CASE(
    "auxiliary values: means over those that brought one, object of the lowest sample") {
    Film film(FilmLayout{2, 1, 0, 0, {Layer::aovs}});
    film.add_aov(0, 0, 5, {true, 2, {1, 2, 3}, {0, 0, 1}, {0.5f, 0, 0}, 7});
    film.add_aov(0, 0, 3, {true, 4, {3, 2, 1}, {0, 1, 0}, {0.1f, 0, 0}, 9});
    film.add_aov(0, 0, 1, {false, 99, {9, 9, 9}, {9, 9, 9}, {0, 0, 0}, 0});
    CHECK(film.aov("depth.Z") == std::vector<float>{3, 0});
    CHECK(film.aov("P.X") == std::vector<float>{2, 0});
    CHECK(film.aov("N.Y") == std::vector<float>{0.5f, 0});
    CHECK(film.aov("albedo.R")[0] == doctest::Approx(0.2));
    CHECK(film.object_ids() == std::vector<std::uint32_t>{9, 0});
    CHECK_THROWS_WITH_AS(film.aov("normal"), doctest::Contains("depth.Z"), Error);
    const Film bare(FilmLayout{2, 2, 0, 0});
    CHECK_THROWS_AS(bare.aov("albedo.R"), Error);
}

TEST_CASE("halves share no sample, make up the picture, and have no ghosts") {
    Film film(FilmLayout{.width = 1, .height = 1, .layers = {Layer::splats, Layer::flare, Layer::halves}}),
        more(film.layout());
    const auto draw = [](Film& to, std::uint32_t sample) {
        const float v = float(sample + 1);
        to.count(0, 0, sample);
        to.add(0, 0, sample, {v, 2 * v, 3 * v});
        splat(to, 0, 0, sample, {8 * v, 0, 0});
        splat(to, 0, 0, sample, {99, 99, 99}, Layer::flare);
    };
    for (const std::uint32_t sample : {0, 1, 2}) draw(film, sample);
    for (const std::uint32_t sample : {3, 4}) draw(more, sample);
    film.merge(more);
    // Samples 0, 2 and 4 are 1, 3 and 5; samples 1 and 3 are 2 and 4.
    CHECK(film.half_xyz(Film::Half::even) == std::vector<float>{3, 6, 9});
    CHECK(film.half_xyz(Film::Half::odd) == std::vector<float>{3, 6, 9});
    CHECK(film.half_xyz(Film::Half::even, true) == std::vector<float>{24, 0, 0});
    draw(film, 5);
    CHECK(film.half_xyz(Film::Half::odd) == std::vector<float>{4, 8, 12});
    CHECK(film.half_xyz(Film::Half::odd, true) == std::vector<float>{32, 0, 0});
    CHECK(film.half_xyz(Film::Half::even) == std::vector<float>{3, 6, 9});
    CHECK_THROWS_AS(Film(FilmLayout{1, 1}).half_xyz(Film::Half::even), Error);
}

TEST_CASE("sums that come as columns of words are added as a merge adds them") {
    const FilmLayout layout{.width = 3, .height = 2,
                            .layers = {Layer::aovs, Layer::splats, Layer::flare, Layer::halves, Layer::coverage,
                                       Layer::catchers, {Layer::bands, 3}, {Layer::channels, 2}}};
    Film merged(layout), added(layout), more(layout);
    std::uint64_t number = 0;
    for (Film* film : {&merged, &added, &more}) {
        number = film == &added ? 0 : number;   // these two begin alike
        for (const std::string& part : film->state_parts()) {
            std::vector<std::uint32_t> words(film->state(part).bytes.size() / 4);
            for (std::uint32_t& word : words) {
                const std::uint64_t dice = hash64(1, number++);
                word = dice % 3 ? std::uint32_t(dice >> 32) : 0;
            }
            film->set_state(part, std::as_bytes(std::span(words)));
        }
    }
    CHECK(whole_state(merged) == whole_state(added));
    merged.merge(more);
    for (const std::string& part : more.state_parts()) {
        const std::span<const std::byte> bytes = more.state(part).bytes;
        std::vector<std::uint32_t> words(bytes.size() / 4);
        std::memcpy(words.data(), bytes.data(), bytes.size());
        const std::size_t each = words.size() / 6;
        const std::vector<std::uint32_t> columns = used_columns(words, each);
        std::vector<std::uint32_t> kept(6 * columns.size());
        take_columns(words, each, columns, kept);
        std::vector<std::byte> sent(4 * kept.size() + 1);   // not aligned, as from a network
        std::memcpy(sent.data() + 1, kept.data(), 4 * kept.size());
        const std::span odd = std::span(sent).subspan(1);
        added.add_state(part, columns, odd);
        CHECK_THROWS_AS(added.add_state(part, columns, odd.subspan(4)), Error);
        CHECK_THROWS_AS(added.add_state(part, std::vector{std::uint32_t(each)}, bytes.first(24)), Error);
        CHECK_THROWS_AS(added.add_state(part, std::vector{1u, 1u}, bytes.first(48)), Error);
    }
    CHECK(whole_state(merged) == whole_state(added));
    CHECK_THROWS_AS(added.add_state("nonsense", {}, {}), Error);
    CHECK_THROWS_AS(added.add_state("objects", {}, {}), Error);
}

TEST_CASE("a bad sample adds no coverage") {
    const auto w = Wavelengths::sample(0.5f);
    const CameraLight good{.light = 1.f, .white = 1, .covered = 1, .objects = {{{3, 1}}}, .object_count = 1};
    const float worst = std::numeric_limits<float>::quiet_NaN();
    for (const bool catchers : {false, true}) {
        CAPTURE(catchers);
        const FilmLayout layout{1, 1, 0, 0, {Layer::coverage, Layer::objects, {Layer::catchers, catchers}}};
        Film film(layout), alone(layout);
        for (Film* f : {&film, &alone}) f->add(0, 0, 0, w, good);
        film.add(0, 0, 1, w, {.light = worst, .white = 1, .covered = 0.5f, .objects = {{{4, 0.5f}}}, .object_count = 1});
        if (catchers) film.add_locked(0, 0, 2, w, {.light = 1.f, .with_objects = worst, .white = 1, .covered = 0.25f});
        CHECK(film.bad_sample_count() == (catchers ? 2 : 1));
        CHECK(film.coverage() == std::vector{1.f});
        for (const char* layer : {"coverage", "objects"})
            CHECK(std::ranges::equal(film.state(layer).bytes, alone.state(layer).bytes));
    }
}

TEST_CASE("a film in the memory of another one is empty") {
    const FilmLayout all{3, 2, 1, 1, {Layer::aovs, Layer::splats, Layer::flare, Layer::halves, Layer::coverage,
                                      Layer::objects, Layer::catchers, {Layer::bands, 2}}};
    const auto draw = [](Film& film) {
        film.add(1, 1, 0, {1, 2, 3});
        film.count(1, 1);
        splat(film, 2, 2, 1, {3, 2, 1});
        film.add_locked(2, 1, 5, Wavelengths::sample(0.5f), {.light = std::numeric_limits<float>::quiet_NaN()});
    };
    const auto memory = [](const Film& film) { return film.state("sums").bytes.data(); };
    const Film fresh(all);
    const KeptFilms keep;
    {
        Film film(all);
        draw(film);
        CHECK(whole_state(film) != whole_state(fresh));
        film.clear();
        CHECK(whole_state(film) == whole_state(fresh));
    }
    const std::byte* place = nullptr;
    {
        const Film another(FilmLayout{5, 5});
        Film film(all);
        draw(film);
        place = memory(film);
    }   // `another` ends last, and is smaller than the kept film
    {
        Film film(all);
        CHECK(whole_state(film) == whole_state(fresh));
        draw(film);
        place = memory(film);
    }
    Film film(all);
    CHECK(memory(film) == place);
    CHECK(whole_state(film) == whole_state(fresh));
    Film drawn(std::move(film));
    draw(drawn);
    CHECK(memory(drawn) == place);
}

TEST_CASE("a small film leaves kept memory alone, and another large one ends it") {
    const FilmLayout large{64, 64}, small{4, 4}, other{64, 65};
    CHECK(KeptFilms::bytes() == 0);
    {
        const KeptFilms keep;
        const std::byte* place = nullptr;
        {
            const Film film(large);
            place = film.state("sums").bytes.data();
        }
        const std::size_t bytes = 64 * 64 * 112;
        CHECK(KeptFilms::bytes() == bytes);
        { const Film pilot(small); CHECK(KeptFilms::bytes() == bytes); }
        CHECK(KeptFilms::bytes() == bytes);
        {
            const Film film(large);
            CHECK(film.state("sums").bytes.data() == place);
            CHECK(KeptFilms::bytes() == 0);
        }
        const Film film(other);
        CHECK(KeptFilms::bytes() == 0);
    }
    CHECK(KeptFilms::bytes() == 0);
}

TEST_CASE("columns of zeros stay away") {
    const std::vector<std::uint32_t> words{0, 5, 0, 7, 0, 0, 0, 9};
    const std::vector<std::uint32_t> columns = used_columns(words, 4);
    CHECK(columns == std::vector<std::uint32_t>{1, 3});
    std::vector<std::uint32_t> kept(4);
    take_columns(words, 4, columns, kept);
    CHECK(kept == std::vector<std::uint32_t>{5, 7, 0, 9});
    CHECK(used_columns(std::vector<std::uint32_t>(8), 4).empty());
}

TEST_CASE("films of different layout do not merge") {
    Film a(FilmLayout{2, 2, 0, 0});
    CHECK_THROWS_AS(a.merge(Film(FilmLayout{2, 2, 1, 0})), Error);
    CHECK_THROWS_AS(a.merge(Film(FilmLayout{2, 2, 0, 0, {Layer::aovs}})), Error);
    CHECK_THROWS_AS(Film(FilmLayout{0, 5, 0, 0}), Error);
    CHECK_THROWS_AS(Film(FilmLayout{100000, 100000, 0, 0}), Error);
}

TEST_CASE("the relative variance of one sample, from the variance of the mean") {
    Film film({2, 1, 0, 0});
    const float dark = 0.01f;
    const int n = 50;
    for (int i = 0; i < n; ++i) {
        const float y = float(hash_uniform(8, i));
        film.add(0, 0, i, {y, y, y});
        film.count(0, 0);
    }
    film.count(1, 0);   // a single sample has no variance
    const auto relative = film.relative_variance(dark);
    const auto mean = film.mean_xyz(), variance = film.variance_rgb();
    const Rgb rgb = rgb_from_xyz({mean[0], mean[1], mean[2]});
    double expected = 0;
    for (int k = 0; k < 3; ++k) expected += variance[k] * n / (rgb[k] * rgb[k] + dark) / 3;
    CHECK(expected > 0.1);
    CHECK(relative[0] == doctest::Approx(expected).epsilon(1e-5));
    CHECK(relative[1] == 0);
}

TEST_CASE("a state out of a damaged file, locks and all, can be drawn into and added") {
    dg::Film film({2, 1, 0, 0, {Layer::aovs}}), other({2, 1, 0, 0, {Layer::aovs}});
    for (const std::string& part : film.state_parts()) {
        const std::vector<std::byte> ones(film.state(part).bytes.size(), std::byte{0xff});
        film.set_state(part, ones);
        other.set_state(part, ones);
    }
    film.add_locked(1, 0, 0, Wavelengths::sample(0.5f), {.light = 1.f});  // would wait for ever
    film.merge(other);
    CHECK(film.sample_counts()[0] == 0xfffffffeu);
    CHECK(std::isfinite(film.mean_xyz()[0]));
}

TEST_CASE("bands hold the mean radiance of their wavelengths, whoever brings it") {
    constexpr int kBands = 16, kSamples = 1 << 16;
    FilmLayout layout{.width = 2, .height = 1, .layers = {Layer::splats, Layer::flare, {Layer::bands, kBands}}};
    Film film(layout), half(layout);
    for (int i = 0; i < kSamples; ++i) {
        Wavelengths w = Wavelengths::sample((i + 0.5f) / kSamples);
        if (i % 2) w.end_secondary();
        Film& to = i % 4 == 1 ? half : film;
        to.add(0, 0, i, w, {.light = 3.f});
        to.splat(0, 0, i, w, 1.f);
        to.splat(0, 0, i, w, 2.f, Layer::flare);
        to.add_locked(1, 0, i, w, {.light = w.d65});
        for (int x = 0; x < 2; ++x) to.count(x, 0);
    }
    film.add(0, 0, kSamples, Wavelengths::sample(0.5f), {.light = std::numeric_limits<float>::quiet_NaN()});
    film.merge(half);
    CHECK(film.bad_sample_count() == 1);
    const std::vector<float> mean = film.means("bands");
    REQUIRE(mean.size() == 2 * kBands);
    const double scale = double(Wavelengths::sample(0.5f).d65[0]) / d65(Wavelengths::sample(0.5f).nm[0]);
    for (int b = 0; b < kBands; ++b) {
        CHECK(mean[b] == doctest::Approx(6).epsilon(0.01));
        double wanted = 0;
        for (int k = 0; k < 100; ++k) wanted += scale * d65(380 + 25 * (b + (k + 0.5) / 100)) / 100;
        CHECK(mean[kBands + b] == doctest::Approx(wanted).epsilon(0.01));
    }
    Film again(layout);
    for (const std::string& part : film.state_parts()) again.set_state(part, film.state(part).bytes);
    CHECK(again.means("bands") == mean);
    layout.layers[Layer::bands] = 8;
    CHECK_THROWS_AS(film.merge(Film(layout)), Error);
    CHECK_THROWS_AS(Film({.width = 2, .height = 1, .layers = {{Layer::bands, 65}}}), Error);
}

TEST_CASE("bands of a film are the same bits in any order") {
    const FilmLayout layout{.width = 1, .height = 1, .layers = {{Layer::bands, 5}}};
    Film forward(layout), backward(layout);
    const auto draw = [](Film& film, int i) {
        film.add(0, 0, i, Wavelengths::sample(float(hash_uniform(3, i))),
                 {.light = std::exp(20 * float(hash_uniform(4, i)))});
    };
    for (int i = 0; i < 500; ++i) draw(forward, i), draw(backward, 499 - i);
    forward.count(0, 0), backward.count(0, 0);
    CHECK(forward.means("bands") == backward.means("bands"));
}

namespace {

/// Two channels: 1 per nm everywhere, and half of it at 600 nm and beyond.
Responses step_responses() {
    std::vector<double> curves(2 * Responses::kNodes, 1.0);
    for (int i = 0; i < Responses::kNodes; ++i) curves[Responses::kNodes + i] = i < 220 ? 0 : 0.5;
    return Responses(std::span<const double>(curves));
}

}  // namespace

TEST_CASE("channels hold light times response, whoever brings it") {
    constexpr int kSamples = 1 << 16;
    FilmLayout layout{.width = 2, .height = 1, .layers = {Layer::splats, Layer::flare, {Layer::channels, 2}}};
    Film film(layout), half(layout);
    for (Film* f : {&film, &half}) f->set_responses(step_responses());
    for (int i = 0; i < kSamples; ++i) {
        Wavelengths w = Wavelengths::sample((i + 0.5f) / kSamples);
        if (i % 2) w.end_secondary();
        Film& to = i % 4 == 1 ? half : film;
        to.add(0, 0, i, w, {.light = 3.f});
        to.splat(0, 0, i, w, 1.f);
        to.splat(0, 0, i, w, 2.f, Layer::flare);
        to.add_locked(1, 0, i, w, {.light = w.d65});
        for (int x = 0; x < 2; ++x) to.count(x, 0);
    }
    film.add(0, 0, kSamples, Wavelengths::sample(0.5f), {.light = std::numeric_limits<float>::quiet_NaN()});
    film.merge(half);
    CHECK(film.bad_sample_count() == 1);
    const std::vector<float> mean = film.mean_channels();
    REQUIRE(mean.size() == 4);
    CHECK(mean[0] == doctest::Approx(6 * 400).epsilon(1e-3));
    CHECK(mean[1] == doctest::Approx(6 * 0.5 * 180.5).epsilon(5e-3));   // half a nm of the step's slope
    CHECK(mean[3] < mean[2] / 2);
    const std::vector<float> xyz = film.mean_xyz();
    for (int i = 3; i < 6; ++i) CHECK(xyz[i] == doctest::Approx(xyz_from_rgb({1, 1, 1})[i - 3]).epsilon(1e-3));
    Film again(layout);   // as out of a file: without responses
    for (const std::string& part : film.state_parts()) again.set_state(part, film.state(part).bytes);
    CHECK(again.mean_channels() == mean);
    layout.layers[Layer::channels] = 3;
    CHECK_THROWS_AS(film.merge(Film(layout)), Error);
    CHECK_THROWS_AS(again.set_responses(Responses()), Error);
    CHECK_THROWS_AS(Film({.width = 2, .height = 1, .layers = {{Layer::channels, 5}}}), Error);
    CHECK_THROWS_AS(Film({.width = 2, .height = 1}).mean_channels(), Error);
}

TEST_CASE("channels beside bands, and XYZ beside both, are the same bits in any order and company") {
    const auto draw = [](Film& film, int i) {
        film.add(0, 0, i, Wavelengths::sample(float(hash_uniform(3, i))), {.light = std::exp(20 * float(hash_uniform(4, i)))});
    };
    const auto film_with = [](int bands, int channels) {
        Film film({.width = 1, .height = 1, .layers = {{Layer::bands, bands}, {Layer::channels, channels}}});
        if (channels) film.set_responses(step_responses());
        film.count(0, 0);
        return film;
    };
    Film forward = film_with(5, 2), backward = film_with(5, 2), alone = film_with(0, 2), plain = film_with(0, 0);
    for (int i = 0; i < 500; ++i) {
        draw(forward, i), draw(backward, 499 - i), draw(alone, i), draw(plain, i);
    }
    CHECK(forward.mean_channels() == backward.mean_channels());
    CHECK(forward.mean_channels() == alone.mean_channels());
    CHECK(forward.means("bands") == backward.means("bands"));
    CHECK(forward.mean_xyz() == plain.mean_xyz());
    CHECK(forward.variance_rgb() == plain.variance_rgb());
}

TEST_CASE("a film that is placed elsewhere keeps its sums and takes other pixels") {
    Film film({3, 2, -1, 0});
    film.count(-1, 0);
    film.add(-1, 0, 0, Vec3f{1, 2, 3});
    film.place(4, 5);
    film.count(4, 5);
    film.count(6, 6);
    film.count(-1, 0);  // outside now
    film.place(-1, 0);
    CHECK(film.sample_counts() == std::vector<std::uint32_t>{2, 0, 0, 0, 0, 1});
    CHECK(film.mean_xyz()[1] == 1);
}

TEST_CASE("bytes of a pixel are those of its parts, whatever the film keeps") {
    constexpr Layer kSix[] = {Layer::aovs, Layer::splats, Layer::flare, Layer::halves, Layer::coverage, Layer::catchers};
    for (int which = 0; which < 64; ++which)
        for (int channels : {0, 3}) {
            FilmLayout l{.width = 3, .height = 2, .layers = {{Layer::channels, channels}, {Layer::bands, 5 * (which % 3)}}};
            for (int k = 0; k < 6; ++k) l.layers[kSix[k]] = which >> k & 1;
            const Film film(l);
            std::size_t bytes = 0;
            for (const std::string& part : film.state_parts()) bytes += film.state(part).bytes.size();
            CHECK(bytes == 6 * Film::pixel_bytes(l));
        }
}
