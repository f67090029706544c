// ray_on_film_test.cpp -- splats of light paths, and the assignment of light paths to samples.
#include "render/ray_on_film.h"

#include <doctest/doctest.h>

#include <cmath>

#include "math/hash.h"
#include "render/light_pass.h"

using namespace dg;

namespace {

const Sensor kSensor{8, 6, 8, 6};   // 1 mm per px
const FilmLayout kRegion{8, 6, 0, 0, {Layer::splats}};

Reprojection landing(Vec2f px, float response = 3) {
    return {kSensor.mm_from_px(px), 1, 1, 0.5f, response};
}

/// Mean Y per pixel of splats at random film points within the frame and 4 px around it.
std::vector<double> mean_splats(const FilmDensity& density, int n) {
    Film film(kRegion);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x) film.count(x, y);
    for (int i = 0; i < n; ++i) {
        const Vec2f px{float(hash_uniform(1, i)) * 16 - 4, float(hash_uniform(2, i)) * 14 - 4};
        const Reprojection there = landing(px);
        const Wavelengths wl = Wavelengths::sample(float(hash_uniform(3, i)));
        const RayOnFilm ray(density, kSensor, {&there, 1}, 0);
        if (!ray.in_reach()) continue;
        ray.splat(film, wl.emission({1, 1, 1}), wl,
                  {float(hash_uniform(4, i)), float(hash_uniform(5, i))}, 0);
    }
    std::vector<double> means;
    const std::vector<float> xyz = film.mean_xyz();
    for (std::size_t i = 0; i < xyz.size() / 3; ++i) means.push_back(xyz[3 * i + 1] * 16.0 * 14 / n);
    return means;
}

}  // namespace

TEST_CASE("splats bring each pixel the integral of its filter, whatever the filter and the counts") {
    std::vector<std::uint32_t> counts(48);
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = std::uint32_t(i % 5);
    for (const auto& [kind, radius] :
         {std::pair{FilterKind::box, 0.5f}, {FilterKind::mitchell, 2.f}, {FilterKind::gaussian, 4.f},
          {FilterKind::tent, 1.f}}) {
        const Filter filter(kind, radius);
        for (const bool even : {true, false}) {
            const FilmDensity density(filter, kRegion, even ? std::span<const std::uint32_t>{} : counts);
            const std::vector<double> means = mean_splats(density, 60'000);
            double sum = 0, expected = 0;
            for (std::size_t i = 0; i < 48; ++i) {
                const double n = even ? 1 : counts[i];
                const double wanted = n * 3 * filter.absolute_integral();   // response x normalization
                if (n == 0) CHECK(means[i] == 0);
                CHECK(std::abs(means[i] - wanted) < 0.4 * wanted + 1e-9);
                sum += means[i], expected += wanted;
            }
            CHECK(sum == doctest::Approx(expected).epsilon(0.02));
        }
    }
}

TEST_CASE("wavelengths land on film points of their own; those that are stopped bring nothing") {
    const Filter filter(FilterKind::box);
    const FilmDensity density(filter, kRegion);
    std::array<Reprojection, kWavelengths> four{landing({1.5f, 1.5f}), landing({2.5f, 1.5f}),
                                                landing({-5, 1}), landing({3.5f, 1.5f})};
    four[3].etendue = 0;
    const RayOnFilm ray(density, kSensor, four, 0);
    CHECK(ray.in_reach());
    CHECK_FALSE(ray.off_frame());
    CHECK(ray.camera_density() == doctest::Approx((1 / 0.5 + 1 / 0.5) / 4));
    Film film(kRegion);
    for (int x = 0; x < 8; ++x) film.count(x, 1);
    const Wavelengths wl = Wavelengths::sample(0.1f);
    ray.splat(film, Spectrum(1), wl, {0.5f, 0.5f}, 0);
    const std::vector<float> xyz = film.mean_xyz();
    const auto luminance = [&](int x) { return xyz[std::size_t(3 * (8 + x) + 1)]; };
    CHECK(luminance(1) == doctest::Approx(wl.to_xyz({3, 0, 0, 0}).y));
    CHECK(luminance(2) == doctest::Approx(wl.to_xyz({0, 3, 0, 0}).y));
    CHECK(luminance(3) == 0);
    const std::array out{landing({-5, 1}), landing({20, 1})};
    CHECK(RayOnFilm(density, kSensor, out, 0).off_frame());
    const FilmLayout crop{2, 2, 0, 0, {Layer::splats}};
    const FilmDensity cropped(filter, crop);
    const std::array beside{landing({5, 5})};   // inside the frame, outside the crop
    CHECK_FALSE(RayOnFilm(cropped, kSensor, beside, 0).off_frame());
    CHECK_FALSE(RayOnFilm(cropped, kSensor, beside, 0).in_reach());
}

TEST_CASE("light paths belong to samples: any split has them all, and parts of a path are right on average") {
    for (const double per_sample : {0.01, 3.7, 1e5 / 3, 1e9}) {
        const auto whole = light_path_range(3, 1000, per_sample, 7);
        const auto first = light_path_range(3, 64, per_sample, 7);
        const auto rest = light_path_range(64, 1000, per_sample, 7);
        CHECK((first[0] == whole[0] && first[1] == rest[0] && rest[1] == whole[1]));
    }
    double sum = 0;
    for (int seed = 0; seed < 4000; ++seed) {
        const auto [a, b] = light_path_range(0, 1, 0.3, std::uint64_t(seed));
        sum += double(b - a);
    }
    CHECK(sum / 4000 == doctest::Approx(0.3).epsilon(0.1));
}
