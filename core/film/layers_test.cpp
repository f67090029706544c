// layers_test.cpp -- the table of layers: how each merges, a layer that is only a row, and layouts that no film can have.
#include "film/layers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "film/film.h"
#include "math/hash.h"

using namespace dg;

namespace {

template <class R>
constexpr std::size_t kWordsOf = sizeof(R) / 4;

template <class R>
R random_record(std::uint64_t seed) {
    std::array<std::uint32_t, kWordsOf<R>> words;
    for (std::size_t k = 0; k < words.size(); ++k) words[k] = std::uint32_t(hash64(seed, k));
    R record;
    std::memcpy(static_cast<void*>(&record), words.data(), sizeof(R));
    return record;
}

template <class R>
std::array<std::uint32_t, kWordsOf<R>> words_of(const R& record) {
    std::array<std::uint32_t, kWordsOf<R>> words;
    std::memcpy(words.data(), static_cast<const void*>(&record), sizeof(R));
    return words;
}

template <class R>
R sum(R a, const R& b) {
    a.add(b);
    return a;
}

/// Words of a record that no merge passes on.
template <class R>
std::vector<std::size_t> forgotten_words() {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < kWordsOf<R>; ++k) {
        bool passed = false;
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            const R one = random_record<R>(seed);
            auto words = words_of(one);
            words[k] /= 2;   // also lower than the record it merges into
            R other;
            std::memcpy(static_cast<void*>(&other), words.data(), sizeof(R));
            const R to = random_record<R>(100 + seed);
            passed = passed || words_of(sum(to, one)) != words_of(sum(to, other));
        }
        if (!passed) found.push_back(k);
    }
    return found;
}

/// Whether merging gives the same bits in any order, and an empty record changes nothing.
template <class R>
bool merges_in_any_order() {
    bool same = true;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const R a = random_record<R>(seed), b = random_record<R>(seed + 1000), c = random_record<R>(seed + 2000);
        const auto wanted = words_of(sum(sum(sum(R(), a), b), c));
        same = same && wanted == words_of(sum(sum(sum(R(), c), a), b)) && wanted == words_of(sum(sum(R(), a), sum(b, c)));
        same = same && wanted == words_of(sum(sum(sum(R(), a), b), sum(c, R())));
    }
    return same;
}

// Planted faults.
struct ForgetsSquares : ColorSums {
    void add(const ForgetsSquares& more) {
        for (int k = 0; k < 3; ++k) xyz[k].add(more.xyz[k]);
    }
};
struct KeepsTheLast {
    std::uint32_t value = 0;
    void add(const KeepsTheLast& more) { value = more.value; }
};
struct StartsAtOne {
    std::uint32_t value = 1;
    void add(const StartsAtOne& more) { value += more.value; }
};
struct DoesNotMerge {
    std::uint64_t value = 0;
};
struct HasGap {
    std::uint64_t value = 0;
    std::uint32_t count = 0;
    void add(const HasGap&) {}
};
struct OwnsMemory {
    std::unique_ptr<int> value;
    void add(const OwnsMemory&) {}
};
struct HalfAWord {
    std::uint16_t value = 0;
    void add(const HalfAWord&) {}
};
static_assert(LayerRecord<CameraSums> && HasMeans<CameraSums> && Settles<CameraSums> && HasMeans<ValueSum>);
static_assert(!HasMeans<HalfSums> && !HasMeans<CoverageSums> && !Settles<ColorSums>);
static_assert(!LayerRecord<DoesNotMerge> && !LayerRecord<HasGap> && !LayerRecord<OwnsMemory> && !LayerRecord<HalfAWord>);

// Sizes of the records in the files of all versions.
static_assert(sizeof(CameraSums) == 112 && sizeof(ColorSums) == 96 && sizeof(HalfSums) == 112 && sizeof(XyzSums) == 48 &&
              sizeof(CoverageSums) == 16 && sizeof(ValueSum) == 16 && sizeof(AovSums) == 16 * (kAovChannels.size() + 1));

/// A layer that no film has: the brightest sample of a pixel.
struct Brightest {
    std::uint32_t brightest = 0, count = 0;
    void add(const Brightest& more) {
        brightest = std::max(brightest, more.brightest);
        count += more.count;
    }
};
constexpr Layer kNew{kLayerCount};
constexpr auto kMoreLayers = std::tuple_cat(
    kLayers, std::tuple{LayerRow<Plane<Brightest>>{kNew, "brightest", nullptr, 0, [](const LayerCounts&) { return 2; }},
                        LayerRow<Plane<XyzSums>>{Layer(kLayerCount + 1), "group", nullptr, 0,
                                                 [](const LayerCounts& asked) { return asked[Layer::splats]; }}});

std::string refusal(const FilmLayout& layout) {
    try {
        const Film film(layout);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("every layer merges all words that matter, in any order") {
    LayerStores<kLayers>::for_each_row([&]<class Row>(const Row& row) {
        if constexpr (!std::is_same_v<typename Row::Store, ObjectLists>) {
            using R = typename Row::Store::Record;
            CAPTURE(row.name);
            CHECK(merges_in_any_order<R>());
            std::vector<std::size_t> unused;
            if (row.layer == Layer::sums) unused = {27};   // the lock
            if (row.layer == Layer::halves) unused = {25, 26, 27};
            CHECK(forgotten_words<R>() == unused);
        }
    });
    CHECK(forgotten_words<ForgetsSquares>().size() == 12);
    CHECK_FALSE(merges_in_any_order<KeepsTheLast>());
    CHECK_FALSE(merges_in_any_order<StartsAtOne>());
}

TEST_CASE("a layer is a row: memory, zeros, merging, its part of files") {
    using More = LayerStores<kMoreLayers>;
    const FilmLayout layout{.width = 3, .height = 2, .layers = {Layer::splats}};
    CHECK(More::pixel_bytes(layout.layers) == Film::pixel_bytes(layout) + 2 * sizeof(Brightest) + sizeof(XyzSums));
    CHECK(More::pixel_bytes({}) == Film::pixel_bytes({}) + 2 * sizeof(Brightest));
    More::check(layout);
    More one(layout), other(layout);
    CHECK(one.names() == std::vector<std::string>{"sums", "splats", "brightest", "group"});
    CHECK(More({.width = 3, .height = 2}).names() == std::vector<std::string>{"sums", "brightest"});
    one.of<kNew>()[3] = {7, 1}, other.of<kNew>()[3] = {5, 4}, other.of<kNew>()[11] = {2, 1};
    one.merge(other);
    CHECK((one.of<kNew>()[3].brightest == 7 && one.of<kNew>()[3].count == 5));
    CHECK((one.of<kNew>()[11].brightest == 2 && one.of<kNew>()[0].count == 0));

    More again(layout);
    const auto bytes_of = [](const More& stores, const FilmLayout& l) {
        std::vector<std::byte> all;
        More::with(stores, "brightest", [&](const auto&, const auto& store) {
            const LayerState state = store.state(l);
            CHECK(state.entries == 3);
            all.assign(state.bytes.begin(), state.bytes.end());
        });
        return all;
    };
    const std::vector<std::byte> bytes = bytes_of(one, layout);
    CHECK(bytes.size() == 6 * 2 * sizeof(Brightest));
    More::with(again, "brightest", [&](const auto& row, auto& store) { store.set_state(row.name, bytes, layout); });
    CHECK(bytes_of(again, layout) == bytes);
    const std::vector<std::uint32_t> counts{3};   // of the second record
    std::vector<std::uint32_t> words(6);
    words[1] = 9;
    More::with(again, "brightest", [&](const auto& row, auto& store) {
        store.add_state(row.name, counts, std::as_bytes(std::span(words)), layout);
    });
    CHECK((again.of<kNew>()[3].brightest == 7 && again.of<kNew>()[3].count == 14));
    again.for_each([](const auto&, auto& store) { store.clear(); });
    CHECK(bytes_of(again, layout) == std::vector<std::byte>(bytes.size()));
    CHECK_THROWS_WITH_AS(More::with(again, "flare", [](auto&, auto&) {}), doctest::Contains("wanted sums or splats or"),
                         Error);
}

TEST_CASE("means of a layer of plain sums are read by its name") {
    Film film({.width = 1, .height = 1, .layers = {Layer::catchers, Layer::coverage}});
    const Wavelengths w = Wavelengths::sample(0.5f);
    for (int i = 0; i < 2; ++i) {
        film.count(0, 0, i);
        film.add(0, 0, i, w, {.light = 1.f, .with_objects = 2.f, .without_objects = 4.f});
    }
    const std::vector<float> sums = film.means("sums"), set = film.means("catchers");
    REQUIRE((sums.size() == 3 && set.size() == 6));
    for (int k = 0; k < 3; ++k) {
        CHECK(set[k] == doctest::Approx(2 * sums[k]));
        CHECK(set[3 + k] == doctest::Approx(4 * sums[k]));
    }
    CHECK(film.means("catchers", 3, 3) == std::vector<float>(set.begin() + 3, set.end()));
    CHECK_THROWS_WITH_AS(film.means("coverage"), "film: means: wanted a layer of plain sums, got coverage", Error);
    CHECK_THROWS_WITH_AS(film.means("flare"), "film: layer: wanted sums or coverage or catchers, got 'flare'", Error);
}

TEST_CASE("a layout that no film can have is refused with one reason") {
    constexpr int kHuge = 2147483647;
    CHECK(refusal({.width = 0, .height = 5}) ==
          "film: size in px: wanted at least 1 x 1 and at most 2^31 pixels, got 0 x 5");
    CHECK(refusal({.width = kHuge, .height = kHuge}).find("at most 2^31 pixels") != std::string::npos);
    // Sizes that would take all memory, so each is refused before.
    const auto vast = [](LayerCounts layers) { return FilmLayout{.width = 46340, .height = 46340, .layers = layers}; };
    CHECK(refusal(vast({Layer::objects})) == "film: objects: wanted coverage, got none");
    CHECK(refusal(vast({{Layer::bands, 65}})) == "film: bands: wanted 0 to 64, got 65");
    CHECK(refusal(vast({{Layer::bands, -1}})) == "film: bands: wanted 0 to 64, got -1");
    CHECK(refusal(vast({{Layer::channels, 5}})) == "film: channels: wanted 0 to 4, got 5");
    CHECK(refusal(vast({{Layer::flare, 2}})) == "film: flare: wanted 0 to 1, got 2");
    CHECK(refusal(vast({{Layer::channel_splats, 1}})) == "film: channel_splats: wanted 0 to 0, got 1");
    CHECK(refusal({.width = 1, .height = 1, .layers = {Layer::objects, Layer::coverage}}).empty());
}
