#include "post/remap.h"

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"

using namespace dg;

namespace {

constexpr int kCell = SourceMap::kCell;

/// Map from a displacement formula: sampled at nodes, or exact on request.
struct TestMap {
    std::vector<float> nodes, cells;
    std::vector<std::int32_t> exact;
    SourceMap map;

    template <typename Formula>
    TestMap(int width, int height, const Formula& d, bool all_exact = false) {
        const int columns = (width + kCell - 1) / kCell,
                  rows = (height + kCell - 1) / kCell;
        const auto put = [&](std::vector<float>& to, int x, int y) {
            const auto [dx, dy] = d(double(x), double(y));
            to.push_back(float(dx)), to.push_back(float(dy));
        };
        for (int j = -1; j < rows + 2; ++j)
            for (int i = -1; i < columns + 2; ++i) put(nodes, i * kCell, j * kCell);
        for (int k = 0; k < rows * columns; ++k) {
            exact.push_back(all_exact ? k : -1);
            for (int p = 0; all_exact && p < kCell * kCell; ++p)
                put(cells, k % columns * kCell + p % kCell,
                    k / columns * kCell + p / kCell);
        }
        map = {columns, rows, 0, nodes, exact, cells};
    }
};

struct TestImage {
    int width, height, channels;
    std::vector<float> values;

    template <typename Formula>
    TestImage(int w, int h, int c, const Formula& f) : width(w), height(h), channels(c) {
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (int k = 0; k < c; ++k) values.push_back(float(f(x, y, k)));
    }
    RemapSource source(int begin, int end) const {
        const std::size_t row = std::size_t(width) * channels;
        return {std::span(values).subspan(begin * row, (end - begin) * row), width,
                height, channels, begin};
    }
    float at(int x, int y, int c) const {
        return values[(std::size_t(y) * width + x) * channels + c];
    }
};

struct Shift {
    double dx, dy;
};

const std::vector<int> kOneMap{0, 0, 0};

/// Keys' cubic (a = -1/2) at a position, by its formula in double; edges are extended.
double keys_cubic(const TestImage& image, double x, double y, int c) {
    const auto weight = [](double d) {
        d = std::abs(d);
        return d < 1   ? (1.5 * d - 2.5) * d * d + 1
               : d < 2 ? ((-0.5 * d + 2.5) * d - 4) * d + 2
                       : 0;
    };
    const int x0 = int(std::floor(x)) - 1, y0 = int(std::floor(y)) - 1;
    double sum = 0, low = INFINITY, high = -low;
    for (int j = y0; j < y0 + 4; ++j)
        for (int i = x0; i < x0 + 4; ++i) {
            const double value = image.at(std::clamp(i, 0, image.width - 1),
                                          std::clamp(j, 0, image.height - 1), c);
            sum += weight(i - x) * weight(j - y) * value;
            low = std::min(low, value), high = std::max(high, value);
        }
    return std::clamp(sum, low, high);
}

/// Runs the body for each instruction set that is compiled in and supported by this machine.
template <typename Body>
void for_each_target(const Body& body) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        INFO("target " << std::string(hwy::TargetName(target)));
        body();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

double parabola(double x, double y, int c) {
    return 2 + 0.01 * x * y + 0.002 * x * x - 0.001 * (c + 1) * y * y;
}

}  // namespace

TEST_CASE("a map of whole pixels moves values without touching them") {
    const TestImage image(
        100, 70, 3, [](int x, int y, int c) { return std::sin(x * 7.1 + y * 3.3 + c); });
    const TestMap map(100, 70, [](double, double) { return Shift{3, -2}; });
    const auto out = remap(image.source(0, 70), {&map.map, 1}, kOneMap, 0, 70,
                           RemapFilter::cubic, true);
    CHECK(out.undefined == 0);
    for (int y = 2; y < 70; ++y)
        for (int x = 0; x < 97; ++x)
            REQUIRE(out.values[(y * 100 + x) * 3 + 1] == image.at(x + 3, y - 2, 1));
    CHECK(out.values[(50 * 100 + 98) * 3] == 0);  // outside
    CHECK(out.values[(1 * 100 + 50) * 3] == 0);
}

TEST_CASE(
    "the cubic is exact for parabolas, between all pixels, near and far from nodes") {
    const TestImage image(90, 80, 3, parabola);
    const auto bend = [](double x, double y) {
        return Shift{2.3 + 1e-3 * x * y, -1.7 + 0.02 * x - 1e-5 * y * y * y};
    };
    for (bool exact : {false, true}) {
        const TestMap map(90, 80, bend, exact);
        const auto out = remap(image.source(0, 80), {&map.map, 1}, kOneMap, 0, 80,
                               RemapFilter::cubic, false);
        int counted = 0;
        for (int y = 10; y < 70; ++y)
            for (int x = 10; x < 70; ++x) {
                const auto [dx, dy] = bend(x, y);
                if (x + dx < 2 || x + dx > 86 || y + dy < 2 || y + dy > 76) continue;
                const double wanted = parabola(x + dx, y + dy, 2);
                REQUIRE(out.values[(y * 90 + x) * 3 + 2] ==
                        doctest::Approx(wanted).epsilon(1e-5));
                ++counted;
            }
        CHECK(counted > 2000);
    }
}

TEST_CASE("any count of channels and any width, to the edges, on every SIMD target") {
    const auto swirl = [](double x, double y) {
        return Shift{0.03 * (y - 20) + 0.2, -0.03 * (x - 30) - 0.1};
    };
    for (const auto& [width, channels] :
         {std::pair(75, 1), {66, 2}, {130, 3}, {61, 4}, {5, 5}}) {
        const TestImage image(width, 41, channels, [](int x, int y, int c) {
            return std::sin(x * 7.1 + y * 3.3 + c);
        });
        const TestMap map(width, 41, swirl);
        const std::vector<int> one(channels, 0);
        for_each_target([&, width = width, channels = channels] {
            const auto out = remap(image.source(0, 41), {&map.map, 1}, one, 0, 41,
                                   RemapFilter::cubic, true);
            for (std::size_t k = 0; k < out.size; ++k) {
                const int c = k % channels, u = k / channels % width,
                          v = k / channels / width;
                const double x = u + swirl(u, v).dx, y = v + swirl(u, v).dy;
                if (x < -0.49 || y < -0.49 || x > width - 0.51 || y > 40.49) continue;
                REQUIRE(std::abs(out.values[k] - keys_cubic(image, x, y, c)) < 1e-5);
            }
        });
    }
}

TEST_CASE("each channel follows its own map") {
    const TestImage image(64, 64, 3, [](int x, int y, int) { return x + 100.0 * y; });
    const TestMap a(64, 64, [](double, double) { return Shift{0.5, 0}; });
    const TestMap b(64, 64, [](double, double) { return Shift{0, 0.25}; });
    const std::vector<SourceMap> maps{a.map, b.map};
    const std::vector<int> map_of{0, 1, 0};
    const auto out =
        remap(image.source(0, 64), maps, map_of, 0, 64, RemapFilter::linear, true);
    const float* pixel = out.values.get() + (20 * 64 + 30) * 3;
    CHECK(pixel[0] == doctest::Approx(2030.5));
    CHECK(pixel[1] == doctest::Approx(2055));
    CHECK(pixel[2] == doctest::Approx(2030.5));
}

TEST_CASE("any cut into bands gives the same bits, from no more rows than it says") {
    const TestImage image(
        150, 130, 3, [](int x, int y, int c) { return std::sin(x * 7.1 + y * 3.3 + c); });
    const auto barrel = [](double x, double y) {
        const double r2 = (x - 75) * (x - 75) + (y - 65) * (y - 65);
        return Shift{(x - 75) * r2 * 2e-5, (y - 65) * r2 * 2e-5};
    };
    const TestMap map(150, 130, barrel);
    const auto all = remap(image.source(0, 130), {&map.map, 1}, kOneMap, 0, 130,
                           RemapFilter::cubic, true);
    for (int begin = 0; begin < 130; begin += 13) {
        const auto part = remap(image.source(0, 130), {&map.map, 1}, kOneMap, begin,
                                begin + 13, RemapFilter::cubic, true);
        for (std::size_t i = 0; i < part.size; ++i)
            REQUIRE(part.values[i] == all.values[std::size_t(begin) * 450 + i]);
    }
    CHECK_THROWS_AS(remap(image.source(60, 70), {&map.map, 1}, kOneMap, 20, 40,
                          RemapFilter::cubic, true),
                    Error);
}

TEST_CASE("lamps get no dark rims, and NaN stays where it is seen") {
    TestImage image(64, 64, 3,
                    [](int x, int y, int) { return x == 30 && y == 30 ? 1e4 : 0.25; });
    image.values[(10 * 64 + 10) * 3] = NAN;
    const TestMap map(64, 64, [](double, double) { return Shift{0.5, 0.3}; });
    const auto out = remap(image.source(0, 64), {&map.map, 1}, kOneMap, 0, 64,
                           RemapFilter::cubic, true);
    int lost = 0;
    for (int i = 0; i < 62 * 64 * 3; ++i) {
        if (i / 3 % 64 == 63) continue;
        lost += std::isnan(out.values[i]);
        if (!std::isnan(out.values[i])) REQUIRE(out.values[i] >= 0.25f);
    }
    CHECK(lost == 16);
    CHECK(std::isnan(out.values[(10 * 64 + 10) * 3]));
}

TEST_CASE("where the map shrinks, a chequered source becomes grey") {
    const TestImage image(512, 512, 3, [](int x, int y, int) { return (x + y) % 2; });
    const auto half = [](double x, double y) {
        return Shift{2.7 * (x - 60) + 0.3, 2.7 * (y - 60) + 0.1};
    };
    const TestMap map(512, 512, half);
    const auto out = remap(image.source(0, 512), {&map.map, 1}, kOneMap, 0, 512,
                           RemapFilter::cubic, true);
    const auto raw = remap(image.source(0, 512), {&map.map, 1}, kOneMap, 0, 512,
                           RemapFilter::cubic, false);
    double most = 0, raw_most = 0;
    for (int y = 55; y < 150; ++y)
        for (int x = 55; x < 150; ++x) {
            most = std::max(most, std::abs(out.values[(y * 512 + x) * 3] - 0.5));
            raw_most = std::max(raw_most, std::abs(raw.values[(y * 512 + x) * 3] - 0.5));
        }
    CHECK(most < 0.02);
    CHECK(raw_most > 0.4);
}

TEST_CASE("a map that is torn still takes every pixel from its place") {
    const TestImage image(400, 300, 3,
                          [](int x, int y, int c) { return x + 1000.0 * y + 0.1 * c; });
    const auto torn = [](double x, double y) {
        const bool swap = int(x) % 2 == 0;
        return Shift{(swap ? 399 - x : x) - x, (swap ? 299 - y : y) - y};
    };
    const TestMap map(400, 300, torn, true);
    const auto out = remap(image.source(0, 300), {&map.map, 1}, kOneMap, 0, 300,
                           RemapFilter::cubic, false);
    for (int y = 0; y < 300; y += 7)
        for (int x = 0; x < 400; ++x) {
            const auto [dx, dy] = torn(x, y);
            REQUIRE(out.values[(y * 400 + x) * 3 + 1] ==
                    image.at(int(x + dx), int(y + dy), 1));
        }
}

TEST_CASE("where a map is not defined pixels are 0 and counted") {
    const TestImage image(48, 48, 3, [](int, int, int) { return 1; });
    const auto cut = [](double x, double) { return Shift{x < 20 ? 0 : NAN, 0}; };
    const TestMap map(48, 48, cut, true);
    const auto out = remap(image.source(0, 48), {&map.map, 1}, kOneMap, 0, 48,
                           RemapFilter::cubic, true);
    CHECK(out.undefined == 28 * 48);
    CHECK(out.values[19 * 3] == 1);
    CHECK(out.values[20 * 3] == 0);
}

TEST_CASE("names of objects are carried over bit for bit") {
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < 40 * 40; ++i) ids.push_back(i * 2654435761u);
    const TestMap map(40, 40, [](double, double) { return Shift{1.4, -2.6}; });
    const auto out = remap_nearest(ids, 40, 40, 0, map.map, 0, 40);
    CHECK(out[10 * 40 + 20] == ids[7 * 40 + 21]);
    CHECK(out[1 * 40 + 20] == 0);
}

TEST_CASE("maps that do not fit are refused") {
    const TestImage image(40, 40, 3, [](int, int, int) { return 1; });
    TestMap map(40, 40, [](double, double) { return Shift{0, 0}; });
    const std::vector<int> wrong{0, 1, 0};
    const auto run = [&](std::span<const int> map_of, int end) {
        return remap(image.source(0, 40), {&map.map, 1}, map_of, 0, end,
                     RemapFilter::cubic, true);
    };
    CHECK_THROWS_AS(run(wrong, 40), Error);
    CHECK_THROWS_AS(run(kOneMap, 60), Error);
    map.exact[0] = 3;
    CHECK_THROWS_AS(run(kOneMap, 40), Error);
    map.exact[0] = -1, map.nodes.pop_back(), map.map.nodes = map.nodes;
    CHECK_THROWS_AS(run(kOneMap, 40), Error);
}
