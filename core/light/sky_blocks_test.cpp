// sky_blocks_test.cpp -- choices by blocks and cells against the picture.
#include "light/sky_blocks.h"

#include <doctest/doctest.h>

#include "math/hash.h"
#include "math/statistics.h"

using namespace dg;

namespace {

/// A clear sky: brighter toward the horizon and toward one side, dark below, with trees, and a sun of `sun` texels.
SkyGrid clear_sky(int width, int sun, float brightness = 1e5f) {
    const int height = width / 2;
    std::vector<float> lum(std::size_t(width) * height);
    for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c) {
            const double theta = kPiD * (r + 0.5) / height, phi = 2 * kPiD * (c + 0.5) / width;
            const bool tree = theta > 1.2 && hash_uniform(c * 40 / width, 5) > 0.6;
            const double sky = (1 + theta) * (1.5 + std::cos(phi)), leaves = hash_uniform(r, c);
            lum[std::size_t(r) * width + c] = theta > 1.6 ? 0.02f : float(tree ? leaves * leaves : sky);
        }
    for (int r = 0; r < sun; ++r)
        for (int c = 0; c < sun; ++c) lum[std::size_t(height / 3 + r) * width + width / 3 + c] = brightness;
    return {width, height, std::move(lum)};
}

/// A picture of noise over four decades.
SkyGrid noise(int width, int height) {
    std::vector<float> lum;
    for (int i = 0; i < width * height; ++i) {
        const double u = hash_uniform(width, i);
        lum.push_back(u < 0.1 ? 0 : float(std::pow(10, 4 * u)));
    }
    return {width, height, std::move(lum)};
}

SkyGrid compensated(const SkyGrid& grid) {
    return grid.compensated(float(SkyBlocks(grid).total() / (4 * kPiD)));
}

Vec2f random_u(std::uint64_t i) {
    return {float(hash_uniform(1, i)) * 0.9999999f, float(hash_uniform(2, i)) * 0.9999999f};
}

float weight_at(const SkyGrid& grid, const SkyBlocks& blocks, Vec3f d) {
    return blocks.weight(grid, grid.place(grid.texels(d)), d);
}

/// Direction at a place in a cell.
Vec3f direction_in(const SkyGrid& grid, int c, int r, float x, float s) {
    return grid.direction(c + double(x), grid.cos_edge[r] + (grid.cos_edge[r + 1] - grid.cos_edge[r]) * s);
}

std::vector<SkyGrid> grids() {
    return {noise(1, 1),   noise(2, 1),       noise(3, 5),         noise(37, 11),
            noise(64, 32), clear_sky(64, 1), clear_sky(500, 1), clear_sky(1024, 3),
            compensated(noise(37, 11)), compensated(clear_sky(500, 1)),
            compensated(SkyGrid(9, 5, std::vector<float>(45, 2.f)))};
}

/// p-value of the numbers of samples in each cell; `fault`: relative error of the expected numbers in every other cell.
double p_value(const SkyGrid& grid, int samples, double fault = 0) {
    const SkyBlocks blocks(grid);
    const std::size_t cells = std::size_t(grid.width) * grid.rows();
    std::vector<double> observed(cells), expected(cells);
    for (int i = 0; i < samples; ++i) {
        const SkyGrid::Place at = grid.place(grid.texels(blocks.sample(grid, random_u(i)).direction));
        ++observed[std::size_t(at.r) * grid.width + at.c];
    }
    for (std::size_t i = 0; i < cells; ++i) {
        const int c = int(i % grid.width), r = int(i / grid.width);
        const double light = grid.solid_angle(r) * weight_at(grid, blocks, grid.center(c, r));
        expected[i] = samples * light / blocks.total() * (1 + (i % 2 ? fault : -fault));
    }
    return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("the density integrates to 1: over a cell it is that of the cell's center") {
    for (const SkyGrid& grid : grids()) {
        const SkyBlocks blocks(grid);
        double sum = 0, light = 0;
        for (int r = 0; r < grid.rows(); ++r)
            for (int c = 0; c < grid.width; ++c) {
                sum += grid.solid_angle(r) * weight_at(grid, blocks, grid.center(c, r));
                light += grid.weight(c, r);
            }
        CAPTURE(grid.width);
        CHECK(blocks.total() == doctest::Approx(light).epsilon(1e-9));
        CHECK(sum == doctest::Approx(light).epsilon(1e-4));
    }
}

TEST_CASE("the density at the direction of a sample is that of the sample") {
    for (const SkyGrid& grid : grids()) {
        const SkyBlocks blocks(grid);
        int apart = 0;
        for (int i = 0; i < 50000; ++i) {
            const SkyDraw draw = blocks.sample(grid, random_u(i));
            REQUIRE(draw.weight >= 0);
            REQUIRE(std::abs(length(draw.direction) - 1) < 1e-5f);
            const float again = weight_at(grid, blocks, draw.direction);
            apart += std::abs(again - draw.weight) > 0.01f * draw.weight + 1e-4f;
        }
        CAPTURE(grid.width);
        CHECK(apart < 25);   // directions that rounding takes over the edge of a block
    }
}

TEST_CASE("samples follow the density in every cell: chi-square") {
    CHECK(p_value(noise(37, 11), 400000) > 1e-3);
    CHECK(p_value(noise(64, 32), 400000) > 1e-3);
    CHECK(p_value(clear_sky(64, 1, 300), 400000) > 1e-3);
    CHECK(p_value(clear_sky(500, 2, 3000), 1000000) > 1e-3);
    CHECK(p_value(compensated(clear_sky(500, 2, 3000)), 1000000) > 1e-3);
    CHECK(p_value(noise(64, 32), 400000, 0.03) < 1e-3);
}

TEST_CASE("compensation: the mean is subtracted, a tenth of the luminance remains") {
    std::vector<float> texels(32 * 16, 1.f);
    texels[7 * 32 + 5] = 1000;
    const SkyGrid grid(32, 16, texels), rest_of = compensated(grid);
    double total = 0, rest = 0;
    for (int r = 0; r < grid.rows(); ++r)
        for (int c = 0; c < grid.width; ++c) total += grid.weight(c, r), rest += rest_of.weight(c, r);
    const double mean = total / (4 * kPiD);
    const auto bright = rest_of.corners(5, 7), dark = rest_of.corners(20, 3);
    CHECK(bright[2] == doctest::Approx(1000 - mean));
    CHECK(dark[0] == doctest::Approx(0.1));
    CHECK(rest < total - 0.8 * 4 * kPiD);
    for (const float luminance : {0.f, 1e-3f, 1.f, 3.f, 5.f, 1e3f, 1e6f}) {
        CHECK(rest_of.luminance_of(rest_of.weight_of(luminance)) == doctest::Approx(luminance));
        CHECK(grid.luminance_of(grid.weight_of(luminance)) == luminance);
    }
    const SkyGrid even = compensated(SkyGrid(32, 16, std::vector<float>(512, 2.f)));   // an even sky stays even
    CHECK(even.weight(3, 3) / even.solid_angle(3) == doctest::Approx(0.2));
}

TEST_CASE("samples around a sun are as dense as the sky there, although the sun takes nearly all of them") {
    const SkyGrid grid = clear_sky(1500, 1, 1e6f);   // the sun is the corner of cells 499, 500 of rows 250, 251
    const SkyBlocks blocks(grid);
    const int side = blocks.side();
    REQUIRE(side == 8);
    REQUIRE_FALSE(blocks.is_even(500, 250));
    const auto near_sun = [&](int c, int r) {   // cells of its block that it does not reach
        const bool same_block = c / side == 500 / side && r / side == 250 / side;
        return same_block && !((c == 499 || c == 500) && (r == 250 || r == 251));
    };
    double found = 0, wanted = 0;   // found: sum over samples of 1 / density
    const int n = 8000000;
    for (int i = 0; i < n; ++i) {
        const SkyDraw draw = blocks.sample(grid, random_u(i));
        const SkyGrid::Place at = grid.place(grid.texels(draw.direction));
        if (near_sun(at.c, at.r)) found += blocks.total() / draw.weight / n;
    }
    for (int r = 0; r < grid.rows(); ++r)
        for (int c = 0; c < grid.width; ++c)
            if (near_sun(c, r)) wanted += grid.solid_angle(r);
    CHECK(found == doctest::Approx(wanted).epsilon(0.12));
}

TEST_CASE("a sun of one texel keeps its density") {
    for (const int width : {64, 500, 1024, 2048}) {
        const SkyGrid grid = clear_sky(width, 1);
        const SkyBlocks blocks(grid);
        const int column = width / 3, row = width / 2 / 3;   // the texel: a corner of four cells
        for (const int c : {column - 1, column})
            for (const int r : {row, row + 1}) {
                CHECK_FALSE(blocks.is_even(c, r));
                for (int i = 0; i < 16; ++i) {
                    const float x = (float(i % 4) + 0.5f) / 4, s = (float(i / 4) + 0.5f) / 4;
                    const auto k = grid.corners(c, r);
                    const double wanted = (k[0] * (1 - x) + k[1] * x) * (1 - s) + (k[2] * (1 - x) + k[3] * x) * s;
                    CHECK(weight_at(grid, blocks, direction_in(grid, c, r, x, s)) ==
                          doctest::Approx(wanted).epsilon(3e-3));
                }
            }
    }
}

TEST_CASE("on both sides of the edge of a block the density is that of the block, also where the picture wraps") {
    const SkyGrid grid = clear_sky(500, 1);
    const SkyBlocks blocks(grid);
    const int side = blocks.side();
    REQUIRE(side > 1);
    const auto mean_of = [&](int c, int r) {   // of the block of a cell
        double light = 0, solid_angle = 0;
        for (int j = r / side * side; j < std::min(r / side * side + side, grid.rows()); ++j)
            for (int i = c / side * side; i < std::min(c / side * side + side, grid.width); ++i)
                light += grid.weight(i, j), solid_angle += grid.solid_angle(j);
        return light / solid_angle;
    };
    int even = 0, fine = 0;
    for (int r = 2; r + 2 < grid.rows(); ++r)
        for (int c = 0; c < grid.width; ++c)
            for (const float x : {0.01f, 0.99f})
                for (const float s : {0.02f, 0.98f}) {
                    const auto k = grid.corners(c, r);
                    const double exact = (k[0] * (1 - x) + k[1] * x) * (1 - s) + (k[2] * (1 - x) + k[3] * x) * s;
                    const bool is_even = blocks.is_even(c, r);
                    ++(is_even ? even : fine);
                    const double wanted = is_even ? mean_of(c, r) : exact;
                    const double got = weight_at(grid, blocks, direction_in(grid, c, r, x, s));
                    REQUIRE(std::abs(got - wanted) <= 1e-2 * wanted + 1e-4 * (k[0] + k[1] + k[2] + k[3]));
                }
    CHECK(even > 100000);
    CHECK(fine > 10000);
}

TEST_CASE("an even block never loses much: weights of samples stay near 1") {
    const SkyGrid grid = clear_sky(1024, 3);
    const SkyBlocks blocks(grid);
    double sum = 0, square = 0, most = 0;
    const int n = 400000;
    for (int i = 0; i < n; ++i) {
        const SkyDraw draw = blocks.sample(grid, random_u(i));
        const SkyGrid::Place at = grid.place(grid.texels(draw.direction));
        const double weight = grid.weight(at, draw.direction) / draw.weight;
        sum += weight / n, square += weight * weight / n, most = std::max(most, weight);
    }
    CHECK(sum == doctest::Approx(1).epsilon(0.005));
    CHECK(square < 1.2);
    CHECK(most < 3.05);
}

TEST_CASE("smooth skies are read from the table of blocks alone, and memory has bounds") {
    const auto even_share = [](const SkyGrid& grid) {
        const SkyBlocks blocks(grid);
        double even = 0;
        for (int r = 0; r < grid.rows(); ++r)
            for (int c = 0; c < grid.width; ++c) even += blocks.is_even(c, r) ? grid.weight(c, r) : 0;
        return even / blocks.total();
    };
    CHECK(even_share(clear_sky(1024, 1, 1)) > 0.8);
    CHECK(even_share(clear_sky(1024, 4)) < 0.8);
    for (const SkyGrid& grid : {noise(1024, 512), noise(2000, 700), clear_sky(2048, 1)}) {
        const std::size_t texels = std::size_t(grid.width) * grid.height;
        const std::size_t own = texels * sizeof(float) + grid.cos_edge.size() * sizeof(double);
        const std::size_t bytes = SkyBlocks(grid).bytes() + own;
        CHECK(bytes < 24 * texels);
        CHECK(bytes < 14 * texels + SkyBlocks::kMostBytes);
    }
    CHECK(SkyBlocks(SkyGrid(4096, 8, std::vector<float>(4096 * 8, 2.f))).bytes() <= SkyBlocks::kMostBytes);
}

TEST_CASE("a black picture has no light") {
    const SkyGrid grid(8, 4, std::vector<float>(32));
    const SkyBlocks blocks(grid);
    CHECK(blocks.total() == 0);
    CHECK(weight_at(grid, blocks, {0, 1, 0}) == 0);
}
