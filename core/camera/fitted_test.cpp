// fitted_test.cpp -- fitted exact lenses against tracing of their surfaces.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "camera/exact.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

ExactLensSettings at(double f_stop, int degree, Vec2d tilt = {}, const Iris& iris = {}) {
    ExactLensSettings s;
    s.f_stop = f_stop, s.iris = iris, s.focus_distance_m = 2, s.half_diagonal_mm = 18;
    s.tilt_deg = tilt, s.fitted = FittedGlass{degree};
    return s;
}

Prescription squeezing() {
    Prescription lens = test::tessar();
    lens.surfaces[0].shape = Shape::biconic;
    lens.surfaces[0].curvature_x = 1.05 * lens.surfaces[0].curvature;
    return lens;
}

std::vector<CameraSample> some_samples(int count, double reach = 12) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> u(0, 1);
    std::vector<CameraSample> samples(count);
    for (CameraSample& s : samples)
        s = {{float(reach) * (2 * u(random) - 1), float(reach) * (2 * u(random) - 1)},
             {u(random), u(random)},
             0,
             390 + 380 * u(random)};
    return samples;
}

std::vector<CameraRay> drawn(const ExactLens& lens, const std::vector<CameraSample>& samples) {
    std::vector<CameraRay> rays(samples.size());
    lens.generate(samples, rays);
    return rays;
}

struct Case {
    Prescription lens;
    ExactLensSettings settings;
};

std::vector<Case> cases() {
    return {{test::check_lens(true, 0.5), at(2.8, 7)},
            {test::check_lens(true, 0.5), at(4, 7, {}, Iris::polygon(5, 10, 0))},
            {test::tessar(), at(4, 7)},
            {test::tessar(), at(5.6, 5, {4, -3})},
            {squeezing(), at(5.6, 5)}};
}

}  // namespace

TEST_CASE("a fitted lens draws the exact lens's rays, as near as it says") {
    for (const Case& c : cases()) {
        const ExactLens fitted(c.lens, c.settings), exact = fitted.without_fit();
        REQUIRE(fitted.fit());
        CHECK(!exact.fit());
        CHECK(fitted.h0() == exact.h0());
        const auto samples = some_samples(4000);
        const auto a = drawn(fitted, samples), b = drawn(exact, samples);
        int both = 0, either = 0;
        double squares = 0, light = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            either += a[i].weight > 0 || b[i].weight > 0;
            if (!(a[i].weight > 0 && b[i].weight > 0)) continue;
            ++both;
            CHECK(a[i].aim_weight == b[i].aim_weight);
            const double e = length(to_double(a[i].ray.direction) - to_double(b[i].ray.direction));
            squares += e * e;
            const double t = (a[i].weight - b[i].weight) / b[i].aim_weight;
            light += t * t;
        }
        CHECK(both > 2000);
        CHECK(both > 0.995 * either);
        const FitErrorZone& said = fitted.fit()->error.all;
        CHECK(std::sqrt(squares / both) < 1.5 * said.direction.rms + 3e-7);
        CHECK(std::sqrt(light / both) < 1.5 * said.transmittance.rms + 1e-6);
    }
}

TEST_CASE("what a fitted lens draws it follows back to where it came from, with the same density") {
    for (const Case& c : cases()) {
        const ExactLens fitted(c.lens, c.settings);
        const auto samples = some_samples(2000);
        auto rays = drawn(fitted, samples);
        std::vector<float> nm;
        for (const CameraSample& s : samples) nm.push_back(s.wavelength_nm);
        std::vector<Reprojection> back(rays.size());
        fitted.reproject(rays, nm, back);
        int passed = 0;
        double worst = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!(rays[i].weight > 0) || !(back[i].aim_weight > 0)) continue;
            ++passed;
            worst = std::max(worst, double(length(back[i].film_mm - samples[i].film_mm)));
            CHECK(back[i].aim_weight == doctest::Approx(rays[i].aim_weight).epsilon(2e-3));
            CHECK(back[i].transmittance * back[i].aim_weight == doctest::Approx(rays[i].weight).epsilon(3e-3));
        }
        CHECK(passed > 1000);
        CHECK(worst < 2e-4);
    }
}

TEST_CASE("a lens with the fit of another draws as the other does") {
    const Prescription lens = test::tessar();
    const ExactLens coarse(lens, at(4, 3)), fine(lens, at(4, 7));
    const auto samples = some_samples(500);
    const auto a = drawn(coarse.with_fit(*fine.fit()), samples), b = drawn(fine, samples), c = drawn(coarse, samples);
    int moved = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].weight == b[i].weight);
        CHECK(a[i].ray.direction == b[i].ray.direction);
        moved += a[i].ray.direction != c[i].ray.direction;
    }
    CHECK(moved > 100);
}

TEST_CASE("a state of a body is fitted as it is drawn exactly") {
    const Prescription lens = test::tessar();
    ExactLensSettings near = at(4, 7);
    near.focus_distance_m = 1.5;
    const ExactLens middle(lens, at(4, 7)), state = ExactLens(lens, near).in_the_body_of(middle);
    const auto samples = some_samples(1000, 8);
    const auto a = drawn(state, samples), b = drawn(state.without_fit(), samples);
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!(a[i].weight > 0 && b[i].weight > 0)) continue;
        CHECK(length(a[i].ray.direction - b[i].ray.direction) < 2e-4);
        CHECK(length(a[i].ray.origin - b[i].ray.origin) < 1e-5);
        CHECK(a[i].aim_weight == b[i].aim_weight);
    }
}
