#include "optics/polynomial/lens_fit.h"

#include <doctest/doctest.h>

#include <cmath>

#include "math/error.h"
#include "optics/paraxial.h"
#include "optics/quasi_random.h"
#include "optics/test_lenses.h"

using namespace dg;

namespace {

LensFitRequest request(const Prescription& lens, double film_radius, int degree, double f_stop = 0) {
    const FirstOrder order = first_order(lens);
    LensFitRequest r;
    r.film_z = film_position(lens, order, 1e9), r.film_radius = film_radius, r.degree = degree;
    r.iris_radius = iris_radius(lens, order, f_stop > 0 ? f_stop : order.f_number);
    return r;
}

/// Film rays all over the fit's film and pupil.
FitRay any_ray(const LensFit& fit, int n) {
    const auto u = quasi_random<5>(n);
    const double a = 2 * kPiD * u[0], b = 2 * kPiD * u[1];
    const Vec2d f = Vec2d{std::cos(a), std::sin(a)} * std::sqrt(u[2]);
    const Vec2d q = Vec2d{std::cos(b), std::sin(b)} * std::sqrt(u[3]);
    return {{f.x * fit.film_half.x, f.y * fit.film_half.y}, fit.pupil.slope(f, q), 380 + 400 * u[4]};
}

}  // namespace

TEST_CASE("a lens fit is as good on fresh rays as it says") {
    const Prescription lens = test::check_lens(true, 0.5);
    const Tracer tracer(lens);
    const LensFit fit = make_lens_fit(tracer, request(lens, 15, 7, 2.8));
    CHECK(fit.error.all.direction.rms < 3e-6);
    CHECK(fit.error.all.direction.max < 10 * fit.error.all.direction.rms);
    double sum = 0, worst = 0;
    int count = 0;
    for (int n = 0; n < 4000; ++n) {
        const FitRay ray = any_ray(fit, n);
        const FitValue v = fit.evaluate(ray);
        const Iris round;
        const auto exact = tracer.to_scene(fit.film_ray(ray), tracer.at(ray.wavelength_nm),
                                           {true, &round, fit.iris_radius});
        if (!exact) continue;
        const double e = length(describe_ray(exact->ray, fit.entrance_pupil_z).direction - v.direction);
        sum += e * e, ++count, worst = std::max(worst, e);
    }
    CHECK(std::sqrt(sum / count) < 1.2 * fit.error.all.direction.rms);
    CHECK(worst < 2 * fit.error.all.direction.max);
}

TEST_CASE("errors of a lens fit fall as its degree rises") {
    const Prescription lens = test::tessar();
    double before = 1;
    for (int degree = 1; degree <= 9; degree += 2) {
        const LensFit fit = make_lens_fit(Tracer(lens), request(lens, 15, degree));
        CHECK(fit.error.all.direction.rms < 0.4 * before);
        before = fit.error.all.direction.rms;
    }
}

TEST_CASE("describing a scene ray and making it again") {
    LensFit fit;
    fit.entrance_pupil_z = 17, fit.front_z = 2, fit.front_curvature = 0.03;
    for (int n = 0; n < 200; ++n) {
        const auto u = quasi_random<4>(n);
        const Vec2d v{4 * u[0] - 2, 4 * u[1] - 2}, e{6 * u[2] - 3, 6 * u[3] - 3};
        const FitDirection d = describe_ray(fit.scene_ray(v, e), fit.entrance_pupil_z);
        CHECK(length(d.direction - v) < 1e-12);
        CHECK(length(d.offset - e) < 1e-11);
    }
}

TEST_CASE("a lens fit turns with the film") {
    const Prescription lens = test::tessar();
    const LensFit fit = make_lens_fit(Tracer(lens), request(lens, 15, 5));
    const double c = std::cos(0.7), s = std::sin(0.7);
    const auto turned = [&](Vec2d p) { return Vec2d{c * p.x - s * p.y, s * p.x + c * p.y}; };
    for (int n = 0; n < 100; ++n) {
        const FitRay ray = any_ray(fit, n);
        const FitValue a = fit.evaluate(ray);
        const FitValue b = fit.evaluate({turned(ray.film), turned(ray.slope), ray.wavelength_nm});
        CHECK(length(turned(a.direction) - b.direction) < 1e-12);
        CHECK(length(turned(a.offset) - b.offset) < 1e-12);
        CHECK(length(turned(a.iris) - b.iris) < 1e-12);
        CHECK(std::abs(a.transmittance - b.transmittance) < 1e-12);
    }
}

TEST_CASE("from the film to the scene and back through a lens fit") {
    for (const Prescription& lens : {test::tessar(), test::check_lens(true, 0.5)}) {
        const LensFit fit = make_lens_fit(Tracer(lens), request(lens, 15, 7, 2.8));
        int tried = 0;
        for (int n = 0; n < 500; ++n) {
            const FitRay ray = any_ray(fit, n);
            const FitValue v = fit.evaluate(ray);
            if (!v.within || length(v.iris) > fit.iris_radius) continue;
            const auto back = fit.to_film(fit.scene_ray(v.direction, v.offset), ray.wavelength_nm);
            REQUIRE(back);
            CHECK(length(back->film - ray.film) < 1e-9);
            CHECK(length(back->slope - ray.slope) < 1e-10);
            ++tried;
        }
        CHECK(tried > 100);
    }
}

TEST_CASE("degrees that are not fitted are refused by name") {
    const Prescription lens = test::tessar();
    for (int degree : {-1, 0, 4, 15})
        CHECK_THROWS_WITH_AS(make_lens_fit(Tracer(lens), request(lens, 15, degree)),
                             doctest::Contains("degree: wanted an odd number from 1 to 13"), Error);
}
