#include "render/flare/flare_cells.h"

#include <doctest/doctest.h>

#include "math/sampler.h"

using namespace dg;

namespace {

FlareCells some_cells() {
    FlareCells cells;
    cells.front = {{-0.8f, -0.6f}, {1.4f, 1.2f}};
    cells.outer = {{-0.5f, -0.2f}, {0.9f, 0.6f}};
    cells.inner = {{-0.1f, 0}, {0.4f, 0.3f}};
    const float weights[] = {1, 2, 3, 4};
    cells.weights = Distribution2D(2, 2, weights);
    const double bins[] = {0.5, 1.5, 1};
    cells.wavelengths = DiscreteDistribution(std::span<const double>(bins));
    cells.blind = 0.3f;
    return cells;
}

}  // namespace

TEST_CASE("places on the front are drawn by their density") {
    constexpr int kCount = 1 << 16;
    for (const FlareCells& cells : {some_cells(), FlareCells::evenly({{-0.8f, -0.6f}, {1.4f, 1.2f}})}) {
        double areas[3] = {}, all = 0;   // areas of rectangles and square, estimated from samples
        for (int i = 0; i < kCount; ++i) {
            PathSampler sampler(1, 2, std::uint32_t(i), 3);
            const Vec2f at = cells.sample(sampler.next_2d());
            const double share = 1 / cells.pdf(at) / kCount;
            all += share;
            if (cells.inner.holds(at)) areas[0] += share;
            if (cells.outer.holds(at)) areas[1] += share;
            if (cells.front.holds(at)) areas[2] += share;
        }
        CHECK(all == doctest::Approx(4).epsilon(0.01));
        CHECK(areas[0] == doctest::Approx(cells.inner.area()).epsilon(0.01));
        CHECK(areas[1] == doctest::Approx(cells.outer.area()).epsilon(0.01));
        CHECK(areas[2] == doctest::Approx(cells.front.area()).epsilon(0.01));
    }
}

TEST_CASE("wavelengths are drawn by their density, four at a time and the hero among all") {
    constexpr int kCount = 1 << 12;
    const FlareCells cells = some_cells();
    double all = 0, mean = 0, hero = 0, hero_mean = 0;
    for (int i = 0; i < kCount; ++i) {
        const FlareLambda four = cells.lambda((float(i) + 0.5f) / kCount);
        for (int k = 0; k < kWavelengths; ++k) {
            all += 1 / double(four.density[k]) / (kWavelengths * kCount);
            mean += four.u[k] / double(four.density[k]) / (kWavelengths * kCount);
        }
        hero += 1 / double(four.density[0]) / kCount, hero_mean += four.u[0] / double(four.density[0]) / kCount;
    }
    CHECK(all == doctest::Approx(1).epsilon(0.002));
    CHECK(mean == doctest::Approx(0.5).epsilon(0.002));
    CHECK(hero == doctest::Approx(1).epsilon(0.002));
    CHECK(hero_mean == doctest::Approx(0.5).epsilon(0.002));
}
