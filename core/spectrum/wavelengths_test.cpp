// wavelengths_test.cpp -- sampling against its density, colour round trips, white.
#include "spectrum/wavelengths.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/hash.h"
#include "math/sampler.h"
#include "math/statistics.h"

using namespace dg;

namespace {

constexpr int kBins = 200;

/// Observed: lane k of n stratified paths. Expected: the density at midpoints of the bins.
ChiSquareResult sampler_test(int lane, double fault) {
    const int n = 400000;
    std::vector<double> observed(kBins), expected(kBins);
    for (int i = 0; i < n; ++i) {
        const Wavelengths w =
            Wavelengths::sample(float(hash_uniform(lane, i)) * 0.9999999f);
        ++observed[std::min(int((w.nm[lane] - 380) / 400 * kBins), kBins - 1)];
    }
    for (int b = 0; b < kBins; ++b)
        for (int i = 0; i < 100; ++i) {
            const float nm = 380 + 400 * (float(b) + (float(i) + 0.5f) / 100) / kBins;
            expected[b] += n * wavelength_pdf(nm) * (400.0 / kBins / 100) *
                           (1 + (b % 2 ? fault : -fault));
        }
    return chi_square_test(observed, expected);
}

/// Mean XYZ of an emission over all u by the midpoint rule: the estimate is smooth between table
/// nodes.
Vec3d mean_xyz(Rgb rgb, bool hero_only) {
    const int n = 1 << 17;
    Vec3d sum;
    for (int i = 0; i < n; ++i) {
        Wavelengths w = Wavelengths::sample((float(i) + 0.5f) / n);
        if (hero_only) w.end_secondary();
        sum += to_double(w.to_xyz(w.emission(rgb))) * (1.0 / n);
    }
    return sum;
}

Rgb random_rgb(int i) {
    return {float(hash_uniform(1, i)), float(hash_uniform(2, i)),
            float(hash_uniform(3, i))};
}

}  // namespace

TEST_CASE("each of the four wavelengths follows the stated density") {
    for (int lane = 0; lane < kWavelengths; ++lane)
        CHECK(sampler_test(lane, 0).p_value > 1e-4);
}

TEST_CASE("a density that is 2 % wrong is caught") {
    CHECK(sampler_test(0, 0.02).p_value < 1e-3);
}

TEST_CASE(
    "the density is stated consistently, integrates to 1 and covers colour matching") {
    double integral = 0;
    for (int i = 0; i < 400000; ++i)
        integral += wavelength_pdf(380 + (float(i) + 0.5f) / 1000) / 1000;
    CHECK(integral == doctest::Approx(1).epsilon(1e-4));
    for (int i = 0; i < 10000; ++i) {
        const Wavelengths w = Wavelengths::sample(float(i) / 10000);
        for (int k = 0; k < kWavelengths; ++k) {
            // At the border of two cells, either density is correct.
            const float a = wavelength_pdf(w.nm[k] - 1e-3f),
                        b = wavelength_pdf(w.nm[k] + 1e-3f);
            const bool found = std::abs(w.pdf[k] - a) <= 1e-4f * a ||
                               std::abs(w.pdf[k] - b) <= 1e-4f * b;
            REQUIRE(found);
            REQUIRE(w.nm[k] >= kMinWavelength);
            REQUIRE(w.nm[k] <= kMaxWavelength);
        }
    }
    for (float nm = 380; nm <= 780; nm += 0.5f) CHECK(wavelength_pdf(nm) > 1e-5f);
    CHECK(wavelength_pdf(379.9f) == 0);
    CHECK(wavelength_pdf(780.1f) == 0);
    CHECK(cie_y(379) == 0);
    CHECK(d65(781) == 0);
    CHECK(cie_y(555) == doctest::Approx(1).epsilon(1e-3));
    CHECK(d65(560) == 100);
}

TEST_CASE("rgb -> spectrum -> XYZ -> rgb is the identity under D65") {
    std::vector<Rgb> colours{{1, 1, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 8; ++i) colours.push_back(random_rgb(i));
    for (const Rgb c : colours) {
        const Rgb back = rgb_from_xyz(to_float(mean_xyz(c, false)));
        CHECK(length(back - c) < 1e-5);
    }
    CHECK(length(rgb_from_xyz(to_float(mean_xyz({1, 1.02f, 1}, false))) - Rgb{1, 1, 1}) >
          1e-3);
}

TEST_CASE("white: luminance 1, reflectance exactly 1, matrices exact") {
    CHECK(luminance({1, 1, 1}) == 1.f);
    CHECK(rgb_from_xyz(xyz_from_rgb({1, 1, 1})) == Rgb{1, 1, 1});
    CHECK(mean_xyz({1, 1, 1}, false).y == doctest::Approx(1).epsilon(2e-6));
    for (int i = 0; i < 100000; ++i) {
        const Wavelengths w = Wavelengths::sample(float(hash_uniform(9, i)) * 0.9999999f);
        const Spectrum one = w.reflectance({1, 1, 1});
        for (int k = 0; k < kWavelengths; ++k) {
            REQUIRE(one[k] == 1.f);
            REQUIRE(std::min({w.red[k], w.green[k], w.blue[k]}) >= 0);
            REQUIRE(std::max({w.red[k], w.green[k], w.blue[k]}) <= 1);
        }
    }
    // BT.709-6 with the CIE's white (0.3127, 0.3290); ours differs in the fourth digit.
    const Vec3f white = xyz_from_rgb({1, 1, 1});
    CHECK(white.x / (white.x + white.y + white.z) ==
          doctest::Approx(0.3127).epsilon(1e-3));
    CHECK(luminance({0, 1, 0}) == doctest::Approx(0.7152).epsilon(1e-3));
}

TEST_CASE("matrices are inverse to each other") {
    for (int i = 0; i < 100; ++i)
        CHECK(length(rgb_from_xyz(xyz_from_rgb(random_rgb(i))) - random_rgb(i)) < 1e-6);
}

TEST_CASE("basis in double: agrees with the paths, sums to 1") {
    for (int i = 0; i < 1000; ++i) {
        const Wavelengths w = Wavelengths::sample(float(i) / 1000);
        const Vec3d b = rgb_basis(w.nm[0]);
        CHECK(b.x + b.y + b.z == doctest::Approx(1).epsilon(1e-15));
        CHECK(b.x == doctest::Approx(w.red[0]).epsilon(1e-4));
        CHECK(std::abs(b.z - w.blue[0]) < 1e-4);
    }
}

TEST_CASE("ending the secondary wavelengths is unbiased and idempotent") {
    for (const Rgb c : {Rgb{1, 1, 1}, Rgb{0.9f, 0.2f, 0.1f}, Rgb{0, 0, 1}}) {
        const Vec3d all = mean_xyz(c, false), hero = mean_xyz(c, true);
        CHECK(length(all - hero) < 1e-5);
    }
    Wavelengths w = Wavelengths::sample(0.3f);
    const float before = w.cie_y[0];
    w.end_secondary();
    w.end_secondary();
    CHECK(w.secondary_ended);
    CHECK(w.cie_y[0] == 4 * before);
    CHECK(w.cie_y[1] == 0);
    // Only lane 0 counts, even if terminated lanes carry radiance.
    CHECK(w.to_xyz({0, 5, 6, 7}) == Vec3f{0, 0, 0});
}

TEST_CASE("four wavelengths are rotated quarters: white has little colour noise") {
    double four = 0, hero = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        Wavelengths w = Wavelengths::sample((float(i) + 0.5f) / n);
        const double a = rgb_from_xyz(w.to_xyz(w.emission({1, 1, 1}))).x - 1;
        w.end_secondary();
        const double b = rgb_from_xyz(w.to_xyz(w.emission({1, 1, 1}))).x - 1;
        four += a * a / n;
        hero += b * b / n;
    }
    CHECK(std::sqrt(four) < 0.15);
    CHECK(std::sqrt(hero) > 1);
}
