// Light of a sky's picture on a floor: every strategy has the mean of the integral, with one candidate and with several.
#include <doctest/doctest.h>

#include "math/hash.h"
#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

using Strategy = PathSettings::Strategy;
constexpr int kWidth = 64, kHeight = 32;

/// A grey picture with the luminance of a function of row and column.
template <typename Luminance>
Environment sky(Luminance luminance) {
    EnvironmentImage image{kWidth, kHeight, {}};
    for (int r = 0; r < kHeight; ++r)
        for (int c = 0; c < kWidth; ++c) image.pixels.push_back(Rgb(1, 1, 1) * float(luminance(r, c)));
    return Environment::image(std::move(image), 1, {});
}

/// Radiance of a white floor: the integral of luminance x cosine / pi over the upper half.
double floor_under(const Environment& environment) {
    double sum = 0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < 2 * kSteps; ++j) {
            const double sin2 = (i + 0.5) / kSteps, phi = kPiD * (j + 0.5) / kSteps;   // by projected solid angle
            const Vec3f d{float(std::sqrt(sin2) * std::cos(phi)), float(std::sqrt(1 - sin2)),
                          float(std::sqrt(sin2) * std::sin(phi))};
            sum += luminance(environment.luminance(d, 0)) / (2.0 * kSteps * kSteps);
        }
    return sum;
}

/// Radiance of the floor, relative to emission(1, 1, 1). `lamps`: black lamps that make a vertex draw several candidates.
SampleMoments traced(const Environment& environment, Strategy strategy, int lamps) {
    SceneDescription d;
    Mesh floor;
    floor.positions = {{-20, 0, -20}, {-20, 0, 20}, {20, 0, 20}, {20, 0, -20}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    add(d, floor, {"floor", DiffuseMaterial{{1, 1, 1}}});
    for (int i = 0; i < lamps; ++i)
        d.lights.push_back(SpotLight{{float(i), -5, 0}, {0, -1, 0}, {1, 1, 1}, 0.1f, 0.2f});
    d.environment = environment;
    const auto scene = Scene::build(std::move(d));
    PathSettings settings;
    settings.strategy = strategy;
    std::vector<double> values;
    for (int i = 0; i < 100000; ++i) {
        PathSampler sampler(i % 512, i / 512, 0, 7);
        Wavelengths wl = Wavelengths::sample(0.4f);
        const Ray ray = test_ray({0, 1, 0}, {0.05f, -1, 0.02f});
        const Spectrum l = radiance(*scene, ray, wl, sampler, settings, nullptr, nullptr).sum();
        values.push_back(l[0] / wl.emission({1, 1, 1})[0]);
    }
    return moments(values);
}

double noise(int r, int c) { return std::pow(10, 3 * hash_uniform(r, c)); }
double even(int, int) { return 2; }
double bright_texel(int r, int c) { return r == 9 && c == 20 ? 1e4 : 1; }
double one_texel(int r, int c) { return r == 9 && c == 20 ? 1e4 : 0; }

}  // namespace

TEST_CASE("every strategy has the same mean under a sky: noise, an even sky, a bright texel, one texel in the dark") {
    for (auto* luminance : {noise, even, bright_texel, one_texel}) {
        const Environment environment = sky(luminance);
        const double wanted = floor_under(environment);
        for (const int lamps : {0, 8})
            for (const Strategy strategy : {Strategy::mis, Strategy::light, Strategy::bsdf}) {
                const bool seldom = strategy == Strategy::bsdf && luminance == one_texel;
                const SampleMoments m = traced(environment, strategy, lamps);
                const double error = std::sqrt(m.variance / m.count);
                CAPTURE(lamps);
                CAPTURE(int(strategy));
                CHECK(std::abs(m.mean - wanted) < 4 * error + (seldom ? 0.02 : 0.003) * wanted);
                if (strategy == Strategy::mis) CHECK(error < 0.01 * wanted);
            }
    }
}

}  // namespace dg
