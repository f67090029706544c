#include "optics/expansion/lens_fit_simd.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>

#include "math/quasi_random.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/test_targets.h"

using namespace dg;

namespace {

struct Subject {
    LensFit fit;
    FitTables tables;

    Subject(const Prescription& lens, double film_radius, int degree, int segments = 1) {
        const FirstOrder order = first_order(lens);
        LensFitRequest r;
        r.film_z = film_position(lens, order, 1e9), r.film_radius = film_radius,
        r.degree = degree;
        r.iris_radius = iris_radius(lens, order, order.f_number), r.segments = segments;
        const Tracer tracer(lens);
        fit = make_lens_fit(tracer, r);
        const Iris round;
        tables = make_fit_tables(
            fit, make_lens_tables(tracer, r.film_z, true, &round, r.iris_radius).iris);
    }

    /// Random rays over film and pupil, and slightly beyond.
    void fill(FilmRays& rays) const {
        for (int i = 0; i < kLensBatch; ++i) {
            const auto u = quasi_random<5>(i);
            const double a = 2 * kPiD * u[0], b = 2 * kPiD * u[1];
            const Vec2d f = Vec2d{std::cos(a), std::sin(a)} * (1.02 * std::sqrt(u[2]));
            const Vec2d q = Vec2d{std::cos(b), std::sin(b)} * (1.02 * std::sqrt(u[3]));
            const Vec2d m = fit.pupil.slope(f, q);
            rays.x[i] = float(f.x * fit.film_half.x),
            rays.y[i] = float(f.y * fit.film_half.y);
            rays.mx[i] = float(m.x), rays.my[i] = float(m.y),
            rays.nm[i] = float(380 + 400 * u[4]);
        }
    }
};

std::vector<Subject> subjects() {
    return {Subject(test::tessar(), 20, 7), Subject(test::check_lens(true, 0.5), 20, 9),
            Subject(test::fisheye(), 20, 9, 3), Subject(test::sonnar(), 20, 1)};
}

/// Distance of a ray from the nearest clipping edge, relative to the size of the edge.
double margin(const LensFit& fit, const FitRay& ray, const FitValue& v) {
    const Vec2d f = fit.unit_film(ray.film), q = fit.pupil.q(f, ray.slope);
    double least = std::min(std::abs(1 - length(f)), std::abs(1 - length(q)));
    least = std::min(least, std::abs(1 - length(v.iris) / fit.iris_radius));
    for (std::size_t i = 0; i < fit.mounts.size(); ++i)
        least = std::min(least, std::abs(1 - length(v.mounts[i]) / fit.mounts[i].radius));
    return least;
}

}  // namespace

TEST_CASE("a lens fit in lanes is the fit in double, on every target") {
    const auto in = std::make_unique<FilmRays>();
    const auto out = std::make_unique<SceneRays>();
    for (const Subject& subject : subjects()) {
        subject.fill(*in);
        const LensFit& fit = subject.fit;
        INFO(fit.lens);
        test::for_each_target([&] {
            fit_to_scene(subject.tables, *in, *out, kLensBatch);
            int passed = 0;
            for (int i = 0; i < kLensBatch; ++i) {
                const FitRay ray{{in->x[i], in->y[i]}, {in->mx[i], in->my[i]}, in->nm[i]};
                const FitValue v = fit.evaluate(ray);
                const bool pass = v.within && length(v.iris) <= fit.iris_radius;
                if (margin(fit, ray, v) > 1e-4) CHECK(pass == (out->pass[i] > 0));
                if (!pass || !(out->pass[i] > 0)) continue;
                ++passed;
                const LensRay exact = fit.scene_ray(v.direction, v.offset);
                const Vec3d at{out->x[i], out->y[i], out->z[i] + fit.front_z};
                const Vec3d d{out->dx[i], out->dy[i], out->dz[i]};
                CHECK(length(d - exact.direction) < 2e-6);
                CHECK(length(cross(at - exact.origin, d)) < 1e-4);  // the same line
                CHECK(length(Vec2d{out->iris_x[i], out->iris_y[i]} - v.iris) <
                      1e-5 * (1 + fit.iris_radius));
                CHECK(std::abs(out->pass[i] - v.transmittance) < 1e-5);
            }
            CHECK(passed > 60);
        });
    }
}

TEST_CASE("lanes from the scene find the film ray of the same fit, on every target") {
    const auto film = std::make_unique<FilmRays>();
    const auto back = std::make_unique<FilmRays>();
    const auto scene = std::make_unique<SceneRays>();
    for (const Subject& subject : subjects()) {
        subject.fill(*film);
        INFO(subject.fit.lens);
        test::for_each_target([&] {
            fit_to_scene(subject.tables, *film, *scene, kLensBatch);
            std::vector<float> pass(scene->pass, scene->pass + kLensBatch);
            std::copy(film->nm, film->nm + kLensBatch, back->nm);
            fit_to_film(subject.tables, *scene, *back, kLensBatch);
            for (int i = 0; i < kLensBatch; ++i) {
                if (!(pass[i] > 0)) continue;
                const FitRay ray{
                    {film->x[i], film->y[i]}, {film->mx[i], film->my[i]}, film->nm[i]};
                if (margin(subject.fit, ray, subject.fit.evaluate(ray)) < 1e-3) continue;
                CHECK(std::abs(scene->pass[i] - pass[i]) < 2e-5);
                CHECK(std::hypot(back->x[i] - film->x[i], back->y[i] - film->y[i]) <
                      1e-4);
                CHECK(std::hypot(back->mx[i] - film->mx[i], back->my[i] - film->my[i]) <
                      1e-5);
            }
        });
    }
}
