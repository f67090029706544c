#include "optics/expansion/lens_fit.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "math/error.h"
#include "math/quasi_random.h"
#include "optics/expansion/fit_bend.h"
#include "optics/expansion/fit_equations.h"
#include "optics/expansion/lens_fit_make.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

LensFitRequest request(const Prescription& lens, double film_radius, int degree,
                       double f_stop = 0) {
    const FirstOrder order = first_order(lens);
    LensFitRequest r;
    r.film_z = film_position(lens, order, 1e9), r.film_radius = film_radius,
    r.degree = degree;
    r.iris_radius = iris_radius(lens, order, f_stop > 0 ? f_stop : order.f_number);
    return r;
}

/// Random film rays over the fit's film and pupil.
FitRay any_ray(const LensFit& fit, int n) {
    const auto u = quasi_random<5>(n);
    const double a = 2 * kPiD * u[0], b = 2 * kPiD * u[1];
    const Vec2d f = Vec2d{std::cos(a), std::sin(a)} * std::sqrt(u[2]);
    const Vec2d q = Vec2d{std::cos(b), std::sin(b)} * std::sqrt(u[3]);
    return {{f.x * fit.film_half.x, f.y * fit.film_half.y},
            fit.pupil.slope(f, q),
            380 + 400 * u[4]};
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
        const auto exact =
            tracer.to_scene(fit.film_ray(ray), tracer.at(ray.wavelength_nm),
                            {true, &round, fit.iris_radius});
        if (!exact) continue;
        const double e = length(describe_ray(exact->ray, fit.entrance_pupil_z).direction -
                                v.direction);
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
        CHECK(fit.error.all.direction.rms < 0.5 * before);
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
    const auto turned = [&](Vec2d p) {
        return Vec2d{c * p.x - s * p.y, s * p.x + c * p.y};
    };
    for (int n = 0; n < 100; ++n) {
        const FitRay ray = any_ray(fit, n);
        const FitValue a = fit.evaluate(ray);
        const FitValue b =
            fit.evaluate({turned(ray.film), turned(ray.slope), ray.wavelength_nm});
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
            const auto back =
                fit.to_film(fit.scene_ray(v.direction, v.offset), ray.wavelength_nm);
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
        CHECK_THROWS_WITH_AS(
            make_lens_fit(Tracer(lens), request(lens, 15, degree)),
            doctest::Contains("degree: wanted an odd number from 1 to 13"), Error);
}

TEST_CASE("a lens that is a polynomial is found exactly") {
    const Prescription lens = test::tessar();
    const LensFit truth = make_lens_fit(Tracer(lens), request(lens, 15, 5));
    std::vector<FitSample> samples;
    for (int n = 0; n < 1200; ++n) {
        const FitRay ray = any_ray(truth, n);
        const FitValue v = truth.evaluate(ray);
        FitSample s;
        s.f = truth.unit_film(ray.film), s.q = truth.pupil.q(s.f, ray.slope);
        s.l = truth.scale(ray.wavelength_nm);
        s.direction = v.direction, s.offset = v.offset, s.iris = v.iris;
        s.transmittance = v.transmittance, s.met.resize(lens.surfaces.size());
        for (std::size_t i = 0; i < truth.mounts.size(); ++i)
            s.met[truth.mounts[i].surface] = v.mounts[i];
        samples.push_back(s);
    }
    LensFit found = truth;
    found.segments = {fit_segment(truth, samples, samples, truth.segments[0])};
    for (int n = 1200; n < 1300; ++n) {
        const FitRay ray = any_ray(truth, n);
        const FitValue a = truth.evaluate(ray), b = found.evaluate(ray);
        CHECK(length(a.direction - b.direction) < 1e-11);
        CHECK(length(a.offset - b.offset) < 1e-10);
        // The tolerance allows few terms for these.
        CHECK(length(a.iris - b.iris) < 2e-3 * truth.iris_radius);
        CHECK(std::abs(a.transmittance - b.transmittance) < 3e-3);
    }
}

TEST_CASE("the pursuit finds the columns of a sparse truth") {
    constexpr int kRows = 300, kColumns = 60;
    const int truth[] = {3, 17, 20, 41, 59};
    FitEquations e{kColumns, 1};
    for (int i = 0; i < kRows; ++i) {
        const auto u = quasi_random<5>(i);
        double sum = 0;
        for (int j = 0; j < kColumns; ++j) {
            // A common component makes every column resemble the sum.
            const double v =
                std::cos((j + 1) * 3.1 * u[0] + j * u[1]) + 0.3 * u[2] + 1 + u[3];
            e.matrix.push_back(v);
            for (int k = 0; k < 5; ++k)
                if (truth[k] == j) sum += (1 + 0.5 * k) * v;
        }
        e.rhs.push_back(sum);
    }
    CHECK(e.choose(0, 5) == std::vector<int>(std::begin(truth), std::end(truth)));
    const std::vector<double> x = e.solve_sparse(5);
    for (int k = 0; k < 5; ++k) CHECK(std::abs(x[truth[k]] - (1 + 0.5 * k)) < 1e-9);
    CHECK(std::count(x.begin(), x.end(), 0.0) == kColumns - 5);
}

TEST_CASE("more terms chosen, smaller error, down to that of the complete basis") {
    const Prescription lens = test::tessar();
    LensFitRequest r = request(lens, 15, 7);
    const double complete = make_lens_fit(Tracer(lens), r).error.all.direction.rms;
    double before = 1;
    for (const int terms : {10, 20, 40, 70}) {
        r.terms = terms;
        const LensFit fit = make_lens_fit(Tracer(lens), r);
        const auto& all = fit.segments[0].direction.x.coefficients;
        CHECK(std::count_if(all.begin(), all.end(), [](double c) { return c != 0; }) <=
              terms);
        CHECK(fit.error.all.direction.rms < before);
        before = fit.error.all.direction.rms;
    }
    CHECK(before == doctest::Approx(complete).epsilon(1e-6));
}

TEST_CASE(
    "a lens fit stops the rays that the lens stops, but for a narrow band at each edge") {
    for (const Prescription& lens :
         {test::sonnar(), test::wide_angle(), test::telephoto()}) {
        INFO(lens.name);
        const Tracer tracer(lens);
        const LensFit fit = make_lens_fit(tracer, request(lens, 21, 7));
        CHECK(!fit.mounts.empty());
        const Iris round;
        const double band = 1.5 * (fit.error.all.mount.max + fit.error.all.iris.max);
        int stopped = 0, passed = 0;
        for (int n = 0; n < 6000; ++n) {
            const FitRay ray = any_ray(fit, n);
            const FitValue v = fit.evaluate(ray);
            double edge = std::abs(length(v.iris) - fit.iris_radius);
            for (std::size_t i = 0; i < fit.mounts.size(); ++i)
                edge =
                    std::min(edge, std::abs(length(v.mounts[i]) - fit.mounts[i].radius));
            if (edge < band) continue;
            const bool exact =
                tracer
                    .to_scene(fit.film_ray(ray), tracer.at(ray.wavelength_nm),
                              {true, &round, fit.iris_radius})
                    .has_value();
            CHECK(exact == (v.within && length(v.iris) <= fit.iris_radius));
            (exact ? passed : stopped) += 1;
        }
        CHECK(passed > 500);
        CHECK(stopped > 300);
        CHECK(band < 0.03 * fit.iris_radius);
    }
}

TEST_CASE(
    "segments share the film without gap or overlap, and each fits better than the "
    "whole") {
    const Prescription lens = test::fisheye();
    LensFitRequest r = request(lens, 20, 7);
    const LensFit whole = make_lens_fit(Tracer(lens), r);
    r.segments = 4;
    const LensFit split = make_lens_fit(Tracer(lens), r);
    REQUIRE(split.segments.size() == 4);
    CHECK(split.segments.front().u_low == 0);
    CHECK(split.segments.back().u_high == 1);
    for (int k = 0; k < 3; ++k)
        CHECK(split.segments[k].u_high == split.segments[k + 1].u_low);
    CHECK(split.error.all.direction.rms < 0.3 * whole.error.all.direction.rms);
}

TEST_CASE("lenses without symmetry and tilted films are fitted in all coordinates") {
    Prescription lens = test::tessar();
    lens.surfaces[5].decenter.y = lens.surfaces[6].decenter.y =
        lens.surfaces[7].decenter.y = 0.4;
    LensFitRequest r = request(lens, 15, 5, 4);
    r.film.half = {12, 8};
    const LensFit decentred = make_lens_fit(Tracer(lens), r);
    CHECK(!decentred.symmetry.axial);
    CHECK(decentred.symmetry.mirror_x);
    CHECK(!decentred.symmetry.mirror_y);
    CHECK(decentred.error.all.direction.rms < 5e-5);
    const Prescription straight = test::tessar();
    LensFitRequest tilt = request(straight, 15, 5, 4);
    tilt.film.half = {12, 8};
    const double c = std::cos(0.1), s = std::sin(0.1);
    tilt.tilted = FilmPlane{{0, 0, tilt.film_z}, {1, 0, 0}, {0, c, s}};
    const LensFit tilted = make_lens_fit(Tracer(straight), tilt);
    CHECK(!tilted.symmetry.axial);
    CHECK(tilted.error.all.direction.rms < 5e-5);
    CHECK(tilted.error.all.film.rms < 3);
    for (int n = 0; n < 50; ++n) {
        const FitRay ray{{10 * std::cos(n), 7 * std::sin(2.0 * n)}, {}, 550};
        const Vec2d f = tilted.unit_film(ray.film);
        const FitRay inside{ray.film,
                            tilted.pupil.slope(f, {0.4 * std::sin(3.0 * n), 0.3}), 550};
        const FitValue v = tilted.evaluate(inside);
        const auto back = tilted.to_film(tilted.scene_ray(v.direction, v.offset), 550);
        REQUIRE(back);
        CHECK(length(back->film - inside.film) < 1e-8);
    }
}

TEST_CASE("scene rays from elsewhere in a fit's basis") {
    const Prescription lens = test::tessar();
    const LensFit seven = make_lens_fit(Tracer(lens), request(lens, 15, 7));
    LensFit other = seven;  // in the same coordinates
    for (double& c : other.segments[0].direction.x.coefficients)
        c *= 1 + 0.1 * std::sin(1e5 * c);
    std::vector<FitRay> rays;
    std::vector<FitDirection> scene;
    for (int n = 0; n < 500; ++n) {
        rays.push_back(any_ray(seven, n));
        const FitValue v = other.evaluate(rays.back());
        scene.push_back({v.direction, v.offset});
    }
    const LensFit same = refit_rays(seven, rays, scene);
    for (int n = 500; n < 550; ++n) {
        const FitRay ray = any_ray(seven, n);
        CHECK(length(same.evaluate(ray).direction - other.evaluate(ray).direction) <
              1e-10);
    }
}

TEST_CASE("a bend lowers the error of the same basis") {
    const Prescription lens = test::check_lens(true, 0.5);
    const Tracer tracer(lens);
    const LensFit fit = make_lens_fit(tracer, request(lens, 15, 7, 2.8));
    std::vector<FitSample> samples;
    for (int n = 0; n < 1600; ++n) {
        const FitRay ray = any_ray(fit, n);
        const auto exact =
            tracer.to_scene(fit.film_ray(ray), tracer.at(ray.wavelength_nm), {});
        if (!exact) continue;
        FitSample s;
        s.f = fit.unit_film(ray.film), s.q = fit.pupil.q(s.f, ray.slope);
        s.l = fit.scale(ray.wavelength_nm);
        const FitDirection d = describe_ray(exact->ray, fit.entrance_pupil_z);
        s.direction = d.direction, s.offset = d.offset, s.iris = exact->iris;
        s.transmittance = exact->transmittance, s.met.resize(lens.surfaces.size());
        samples.push_back(s);
    }
    FitSegment straight{0, 1, {}, {}, {}, {}}, bent = straight;
    bent.bend = find_bend(fit, straight, samples);
    CHECK(bent.bend.x.terms.size() == 9);
    const auto left = [&](const FitSegment& domain) {
        return direction_residual(fit, fit_segment(fit, samples, samples, domain),
                                  samples);
    };
    CHECK(left(bent) < 0.4 * left(straight));
}
