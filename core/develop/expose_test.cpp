// expose_test.cpp -- preserved sums, fixed pattern, clipping.
#include "develop/expose.h"

#include <doctest/doctest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>

using namespace dg;

namespace {

/// One channel, an electron per unit of light, shot noise only.
Shot plain() {
    Shot shot;
    shot.electrons = {1};
    shot.cells = {0};
    shot.full_well = 1e6;
    shot.highest_dn = 65535;
    return shot;
}

struct Moments {
    double mean = 0, variance = 0;
};

template <typename T>
Moments moments(const std::vector<T>& values) {
    Moments m;
    for (const T v : values) m.mean += double(v) / double(values.size());
    for (const T v : values) m.variance += (v - m.mean) * (v - m.mean) / double(values.size() - 1);
    return m;
}

Exposed even(const Shot& shot, float light, int size = 256) {
    const std::vector<float> picture(std::size_t(size) * size, light);
    return expose({picture.data(), size, size, 1}, shot);
}

}  // namespace

TEST_CASE("expose: mean equals variance in electrons, gain scales them") {
    Shot shot = plain();
    for (const float light : {3.f, 40.f, 900.f}) {
        const Moments m = moments(even(shot, light).mosaic);
        CHECK(m.mean == doctest::Approx(light).epsilon(4 / std::sqrt(light * 65536)));
        CHECK(m.variance == doctest::Approx(light).epsilon(0.025));
    }
    shot.gain = 0.5;
    shot.black_dn = 64;
    const Moments m = moments(even(shot, 900).mosaic);
    CHECK(m.mean == doctest::Approx(64 + 450).epsilon(1e-3));
    CHECK(m.variance == doctest::Approx(225 + 1. / 12).epsilon(0.025));   // quantization adds 1/12 DN2
}

TEST_CASE("expose: noise of reading, dark current and offsets add up in the dark") {
    Shot shot = plain();
    shot.gain = 8;
    shot.black_dn = 2000;
    shot.read_noise = 4;
    Moments m = moments(even(shot, 0).mosaic);
    CHECK(m.mean == doctest::Approx(2000).epsilon(1e-3));
    CHECK(m.variance == doctest::Approx(64 * 16).epsilon(0.025));
    shot.dark = 20;
    m = moments(even(shot, 0).mosaic);
    CHECK(m.mean == doctest::Approx(2000 + 8 * 20).epsilon(1e-3));
    CHECK(m.variance == doctest::Approx(64 * (16 + 20)).epsilon(0.025));
    shot.dsnu = 5;
    m = moments(even(shot, 0).mosaic);
    CHECK(m.variance == doctest::Approx(64 * (16 + 20 + 25)).epsilon(0.025));
}

TEST_CASE("expose: responses differ by PRNU, of the copy and not of the shot") {
    Shot shot = plain();
    shot.prnu = 0.05;
    shot.serial = 7;
    std::vector<double> mean(65536);
    constexpr int kShots = 16;
    for (int i = 0; i < kShots; ++i) {
        shot.seed = i;
        const Exposed e = even(shot, 10000);
        for (std::size_t j = 0; j < mean.size(); ++j) mean[j] += e.mosaic[j] / double(kShots);
    }
    const double pattern = std::sqrt(moments(mean).variance - 10000. / kShots) / 10000;
    CHECK(pattern == doctest::Approx(0.05).epsilon(0.02));
    shot.serial = 8;
    const Exposed other = even(shot, 10000);
    double together = 0;
    for (std::size_t j = 0; j < mean.size(); ++j)
        together += (mean[j] - 10000) * (other.mosaic[j] - 10000.) / (500. * 500) / 65536;
    CHECK(std::abs(together) < 0.02);
}

TEST_CASE("expose: hot pixels are as many and as hot as said") {
    Shot shot = plain();
    shot.hot_share = 0.01;
    shot.hot_dark = 1000;
    const Exposed e = even(shot, 0, 512);
    int hot = 0;
    double sum = 0;
    for (const auto v : e.mosaic) {
        hot += v > 0;
        sum += v;
    }
    const double wanted = 0.01 * 512 * 512;
    CHECK(std::abs(hot - wanted) < 4 * std::sqrt(wanted) + 0.002 * wanted);
    CHECK(sum / wanted == doctest::Approx(1000).epsilon(4 * std::sqrt(2 / wanted)));
}

TEST_CASE("expose: the well and the converter clip, and say so") {
    Shot shot = plain();
    shot.full_well = 1000;
    Exposed e = even(shot, 5000);
    for (const auto v : e.mosaic) CHECK(v == 1000);
    for (const auto s : e.saturated) CHECK(s == 1);
    e = even(shot, 1e30f, 8);
    CHECK(e.mosaic[0] == 1000);
    e = even(shot, 1000);   // half of the photosites exceed the full well
    int full = 0;
    for (std::size_t i = 0; i < e.mosaic.size(); ++i) {
        CHECK(e.mosaic[i] <= 1000);
        CHECK(e.saturated[i] == (e.mosaic[i] == 1000));
        full += e.saturated[i];
    }
    CHECK(full / 65536. == doctest::Approx(0.5).epsilon(0.04));
    shot.full_well = 1e6;
    shot.highest_dn = 255;
    e = even(shot, 5000);
    for (const auto v : e.mosaic) CHECK(v == 255);
    e = even(shot, 100);
    for (const auto s : e.saturated) CHECK(s == 0);
}

TEST_CASE("expose: each photosite sees its channel") {
    Shot shot = plain();
    shot.channels = 3;
    shot.electrons = {1, 0, 0, 0, 10, 0, 0, 0, 100};
    shot.cells = {0, 1, 1, 2};
    shot.cell_width = shot.cell_height = 2;
    std::vector<float> picture;
    for (int i = 0; i < 64 * 64; ++i) picture.insert(picture.end(), {400.f, 400.f, 400.f});
    const Exposed e = expose({picture.data(), 64, 64, 3}, shot);
    double sums[2][2] = {};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) sums[y % 2][x % 2] += e.mosaic[y * 64 + x] / 1024.;
    CHECK(sums[0][0] == doctest::Approx(400).epsilon(0.01));
    CHECK(sums[0][1] == doctest::Approx(4000).epsilon(0.01));
    CHECK(sums[1][0] == doctest::Approx(4000).epsilon(0.01));
    CHECK(sums[1][1] == doctest::Approx(40000).epsilon(0.01));
}

TEST_CASE("expose: low-pass filter and crosstalk spread points as told, and keep sums at edges, too") {
    constexpr int kSize = 16;
    Shot shot = plain();
    const auto point = [&](int x, int y) {
        std::vector<float> picture(kSize * kSize);
        picture[y * kSize + x] = 40000;
        return expose({picture.data(), kSize, kSize, 1}, shot).mosaic;
    };
    const auto sum = [](const std::vector<std::uint16_t>& m) {
        double s = 0;
        for (const auto v : m) s += v;
        return s;
    };
    shot.low_pass_px = 1;   // two images half a pixel off along either axis: 1 2 1, over 4
    std::vector<std::uint16_t> m = point(8, 8);
    CHECK(m[8 * kSize + 8] == doctest::Approx(10000).epsilon(0.04));
    CHECK(m[8 * kSize + 9] == doctest::Approx(5000).epsilon(0.06));
    CHECK(m[7 * kSize + 7] == doctest::Approx(2500).epsilon(0.08));
    CHECK(m[8 * kSize + 10] == 0);
    shot.low_pass_px = 3;   // 1.5 px off: two pixels each
    m = point(8, 8);
    CHECK(m[8 * kSize + 8] == 0);
    CHECK(m[7 * kSize + 6] == doctest::Approx(2500).epsilon(0.08));
    for (const double distance : {0.7, 1., 3.})
        for (const int at : {0, 1, 8, 15}) {
            shot.low_pass_px = distance;
            CHECK(sum(point(at, 15 - at)) == doctest::Approx(40000).epsilon(0.025));
        }
    shot.low_pass_px = 0;
    shot.crosstalk = 0.2;
    m = point(8, 8);
    CHECK(m[8 * kSize + 8] == doctest::Approx(32000).epsilon(0.02));
    CHECK(m[9 * kSize + 8] == doctest::Approx(2000).epsilon(0.1));
    CHECK(m[9 * kSize + 9] == 0);
    for (const int at : {0, 1, 15}) CHECK(sum(point(at, 8)) == doctest::Approx(40000).epsilon(0.025));
}

TEST_CASE("expose: the same bits on any number of threads, others by another seed") {
    Shot shot = plain();
    shot.prnu = 0.01;
    shot.read_noise = 2;
    shot.crosstalk = 0.1;
    const auto first = even(shot, 100).mosaic;
    {
        const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
        CHECK(even(shot, 100).mosaic == first);
    }
    shot.seed = 1;
    CHECK(even(shot, 100).mosaic != first);
}

TEST_CASE("expose: neighbours, and shots of two seeds, know nothing of each other") {
    constexpr int kSize = 512;
    Shot shot = plain();
    shot.read_noise = 3;
    shot.black_dn = 100;
    const auto first = even(shot, 20, kSize).mosaic;
    shot.seed = 1;
    const auto second = even(shot, 20, kSize).mosaic;
    const Moments m = moments(first);
    double right = 0, below = 0, shots = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const int at = y * kSize + x;
            const double here = first[at] - m.mean;
            right += here * (first[y * kSize + (x + 1) % kSize] - m.mean);
            below += here * (first[(y + 1) % kSize * kSize + x] - m.mean);
            shots += here * (second[at] - m.mean);
        }
    for (const double sum : {right, below, shots})
        CHECK(std::abs(sum / m.variance) < 4 * kSize);   // standard deviation for this number of products: kSize
}

TEST_CASE("expose: light below 0 is none, and counted; what is not finite is placed") {
    std::vector<float> picture(64, 100.f);
    picture[5] = -3;
    picture[6] = -3;
    Exposed e = expose({picture.data(), 8, 8, 1}, plain());
    CHECK(e.negative == 2);
    CHECK(e.mosaic[5] == 0);
    CHECK(e.bad == 0);
    picture[20] = std::numeric_limits<float>::quiet_NaN();
    picture[40] = std::numeric_limits<float>::infinity();
    e = expose({picture.data(), 8, 8, 1}, plain());
    CHECK(e.bad == 2);
    CHECK(e.bad_x == 4);
    CHECK(e.bad_y == 2);
}
