// cover_lists_test.cpp -- lists of objects per pixel: exact in any order, from many threads, through words and back.
#include "film/cover_lists.h"

#include <doctest/doctest.h>

#include <map>
#include <thread>

#include "film/film.h"
#include "math/error.h"
#include "math/hash.h"

using namespace dg;

namespace {

constexpr std::size_t kWidth = 7, kHeight = 5, kPixels = kWidth * kHeight;

struct Draw {
    std::size_t pixel;
    std::uint32_t object;
    std::int64_t steps;
};

/// Lists with few objects in most pixels and many in some; some sums are 0.
std::vector<Draw> all_draws() {
    std::vector<Draw> draws;
    for (std::size_t i = 0; i < 20000; ++i) {
        const std::size_t pixel = hash64(1, i) % kPixels;
        const std::uint32_t many = pixel % 5 == 0 ? 400 : 3;
        const auto steps = std::int64_t(hash64(2, i) % (1ull << 31)) - (1ll << 30);
        draws.push_back({pixel, std::uint32_t(hash64(3, i) % many) * 1000003u, steps});
        if (i % 7 == 0) draws.push_back({pixel, 77, steps}), draws.push_back({pixel, 77, -steps});
    }
    return draws;
}

CoverLists::Entry entry(const std::pair<const std::uint32_t, std::int64_t>& sum) { return {sum.first, sum.second}; }

}  // namespace

TEST_CASE("each object has the sum of what was added, in the order of objects, and none that is 0") {
    CoverLists lists(kPixels);
    std::vector<std::map<std::uint32_t, std::int64_t>> wanted(kPixels);
    for (const Draw& d : all_draws()) {
        lists.add(d.pixel, d.object, d.steps);
        wanted[d.pixel][d.object] += d.steps;
    }
    for (std::size_t i = 0; i < kPixels; ++i) {
        std::erase_if(wanted[i], [](const auto& sum) { return sum.second == 0; });
        std::vector<CoverLists::Entry> sums;
        for (const auto& sum : wanted[i]) sums.push_back(entry(sum));
        CHECK(lists.of(i) == sums);
    }
}

TEST_CASE("lists are the same in any order, split over threads and films") {
    const std::vector<Draw> draws = all_draws();
    CoverLists forward(kPixels), backward(kPixels), threaded(kPixels), one(kPixels), two(kPixels);
    for (const Draw& d : draws) forward.add(d.pixel, d.object, d.steps);
    for (std::size_t i = draws.size(); i-- > 0;) backward.add(draws[i].pixel, draws[i].object, draws[i].steps);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (const Draw& d : draws)
                if (d.pixel % 4 == t) threaded.add(d.pixel, d.object, d.steps);
        });
    for (std::thread& t : threads) t.join();
    for (std::size_t i = 0; i < draws.size(); ++i)
        (i % 3 ? one : two).add(draws[i].pixel, draws[i].object, draws[i].steps);
    one.add(two);
    const auto words = forward.words(kWidth);
    CHECK(backward.words(kWidth) == words);
    CHECK(threaded.words(kWidth) == words);
    CHECK(one.words(kWidth) == words);
    CoverLists again(kPixels);
    again.add(0, 5, 5);   // is replaced
    again.set_words(words, kWidth);
    CHECK(again.words(kWidth) == words);
    for (std::size_t i = 0; i < kPixels; ++i) CHECK(again.of(i) == forward.of(i));
}

TEST_CASE("words that are no lists are refused") {
    CoverLists lists(kPixels);
    lists.add(0, 3, 10), lists.add(1, 2, 5), lists.add(1, 9, 5);
    const auto good = lists.words(kWidth);
    const auto refuses = [&](std::vector<std::uint32_t> words) {
        CoverLists other(kPixels);
        CHECK_THROWS_AS(other.set_words(words, kWidth), Error);
    };
    auto words = good;
    refuses({});
    words.resize(words.size() - 4), refuses(words);
    words = good, words[0] = kWidth, refuses(words);        // beside the picture
    words = good, std::swap(words[5], words[9]), refuses(words);   // objects that fall
    words = good, words[8] = 0, refuses(words);             // columns that fall
    words = good, words[4] = CoverLists::kNowhere, refuses(words);   // a gap
}

TEST_CASE("shares of groups are ranked by magnitude, and what they leave out is told") {
    Film film({.width = 2, .height = 1, .layers = {Layer::coverage, Layer::objects}});
    const Wavelengths nm = Wavelengths::sample(0.5f);
    const auto add = [&](std::vector<ObjectCover> covers) {
        CameraLight light{.white = 1};
        for (const ObjectCover& c : covers) light.objects[light.object_count++] = c, light.covered += c.covered;
        film.count(0, 0), film.add(0, 0, 0, nm, light);
    };
    add({{0, 1.f}}), add({{1, 0.5f}, {2, 0.25f}}), add({{3, 1.f}}), add({{2, 1.f}, {3, -0.25f}});
    const std::vector<std::uint32_t> ids{70, 80, 70, 90};
    const Ranked all = film.ranked(ids, 3);
    CHECK(all.ids == std::vector<std::uint32_t>{70, 90, 80, 0, 0, 0});
    CHECK(all.shares == std::vector<float>{2.25f / 4, 0.75f / 4, 0.5f / 4, 0, 0, 0});
    CHECK(all.cut_pixels == 0);
    CHECK(all.shares[0] + all.shares[1] + all.shares[2] == doctest::Approx(film.coverage()[0]).epsilon(1e-7));
    const Ranked two = film.ranked(ids, 2);
    CHECK(two.ids == std::vector<std::uint32_t>{70, 90, 0, 0});
    CHECK(two.cut_pixels == 1);
    CHECK(two.most_cut == 0.125f);
    CHECK(film.ranked(std::span(ids).first(2), 1).ids[0] == 70);   // objects beyond have no group
    add({{1, -2.f}});   // lobes of a filter are negative
    const Ranked negative = film.ranked(ids, 2);
    CHECK(negative.ids == std::vector<std::uint32_t>{70, 80, 0, 0});
    CHECK(negative.shares[1] == -0.3f);
    CHECK_THROWS_AS(Film({.width = 1, .height = 1, .layers = {Layer::coverage}}).ranked(ids, 2), Error);
    CHECK_THROWS_AS(Film({.width = 1, .height = 1, .layers = {Layer::objects}}), Error);
}
