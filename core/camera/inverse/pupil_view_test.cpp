// Camera rays and light rays through the same lens: same measure, film point and light.
#include "camera/inverse/pupil_view.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "camera/inverse/view_cases.h"

using namespace dg;
using test::Random, test::square, test::wavelength;

TEST_CASE(
    "a ray that the camera draws comes back to its film point with its own weight") {
    for (const test::ViewCase& c : test::view_cases()) {
        CAPTURE(c.name);
        Random random(3);
        std::vector<CameraSample> samples(2000);
        std::vector<float> nm;
        for (CameraSample& s : samples) {
            const Vec2f u = square(random);
            nm.push_back(wavelength(nm.size()));
            s = {{c.half_film_mm.x * (2 * u.x - 1), c.half_film_mm.y * (2 * u.y - 1)},
                 square(random),
                 square(random).x,
                 nm.back(),
                 c.opening};
        }
        std::vector<CameraRay> rays(samples.size());
        generate_rays(c.camera, samples, rays);
        std::vector<Reprojection> back(samples.size());
        reproject(c.camera, rays, nm, back);
        int passed = 0, lost = 0, far = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!(rays[i].weight > 0)) continue;
            ++passed;
            const Reprojection& r = back[i];
            lost += !(r.etendue > 0);  // grazes an edge
            if (!(r.etendue > 0)) continue;
            far += length(r.film_mm - samples[i].film_mm) > 4e-3f;
            CHECK(r.aim_weight * r.transmittance ==
                  doctest::Approx(rays[i].weight).epsilon(2e-3));
            CHECK(r.response * r.etendue ==
                  doctest::Approx(rays[i].weight).epsilon(2e-3));
        }
        CHECK(passed > 500);
        CHECK(lost <= passed / 300 + 2);
        CHECK(far <= passed / 300);
    }
}

namespace {

/// Coordinates of a ray in a frame across another ray.
std::array<double, 4> across(const Ray& ray, Vec3d from, Vec3d x, Vec3d y) {
    const Vec3d d = to_double(ray.direction), z = cross(x, y);
    const Vec3d o = to_double(ray.origin) - from, at = o - d * (dot(o, z) / dot(d, z));
    return {dot(at, x), dot(at, y), dot(d, x), dot(d, y)};
}

double determinant(std::vector<std::array<double, 4>> rows) {
    double product = 1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::size_t best = i;
        for (std::size_t k = i; k < rows.size(); ++k)
            if (std::abs(rows[k][i]) > std::abs(rows[best][i])) best = k;
        std::swap(rows[i], rows[best]);
        product *= rows[i][i];
        for (std::size_t k = i + 1; k < rows.size(); ++k)
            for (std::size_t j = 4; j-- > i;)
                rows[k][j] -= rows[k][i] / rows[i][i] * rows[i][j];
    }
    return std::abs(product);
}

/// Checks that most ratios are 1 within the tolerance; warps have creases.
void check_most(std::vector<double>& ratios, double tolerance) {
    std::sort(ratios.begin(), ratios.end());
    CHECK(ratios.size() > 30);
    if (ratios.empty()) return;
    CHECK(ratios[ratios.size() / 8] == doctest::Approx(1).epsilon(tolerance));
    CHECK(ratios[ratios.size() - 1 - ratios.size() / 8] ==
          doctest::Approx(1).epsilon(tolerance));
}

}  // namespace

TEST_CASE(
    "etendue is how far rays spread as film and lens samples move: of ideal lenses") {
    for (const test::ViewCase& c : test::ideal_cases()) {
        if (test::is_hole(c.camera.lens)) continue;
        CAPTURE(c.name);
        Random random(11);
        std::vector<double> ratios;
        for (int i = 0; i < 100; ++i) {
            const Vec2f u = square(random), v = square(random);
            const CameraSample middle{{30 * u.x - 15, 20 * u.y - 10},
                                      {0.1f + 0.8f * v.x, 0.1f + 0.8f * v.y},
                                      square(random).x,
                                      550,
                                      c.opening};
            std::vector<CameraSample> samples(9, middle);
            for (int k = 0; k < 8; ++k) {
                const float sign = k % 2 ? -1 : 1;
                if (k / 2 == 0) samples[k].film_mm.x += sign * 0.05f;
                if (k / 2 == 1) samples[k].film_mm.y += sign * 0.05f;
                if (k / 2 == 2) samples[k].u_lens.x += sign * 0.005f;
                if (k / 2 == 3) samples[k].u_lens.y += sign * 0.005f;
            }
            std::vector<CameraRay> rays(9);
            generate_rays(c.camera, samples, rays);
            if (!(rays[8].weight > 0)) continue;
            const Vec3d z = to_double(rays[8].ray.direction),
                        x = normalize(cross(Vec3d{0, 1, 0}, z));
            const Vec3d y = cross(z, x), from = to_double(rays[8].ray.origin);
            std::vector<std::array<double, 4>> rows(4);
            for (int k = 0; k < 4; ++k) {
                const auto a = across(rays[2 * k].ray, from, x, y),
                           b = across(rays[2 * k + 1].ray, from, x, y);
                for (int j = 0; j < 4; ++j)
                    rows[k][j] = (a[j] - b[j]) / (k < 2 ? 0.1 : 0.01);
            }
            std::vector<Reprojection> back(1);
            reproject(c.camera, {&rays[8], 1}, std::vector<float>{550}, back);
            ratios.push_back(determinant(rows) / back[0].etendue);
        }
        check_most(ratios, 3e-3);
    }
}

/// Visits all lenses with an opening and their points: check(view, point).
template <typename Check>
void from_each_point(const Check& check) {
    for (const test::ViewCase& c : test::view_cases()) {
        if (test::is_hole(c.camera.lens)) continue;
        const PupilViewOverTime view(c.camera);
        for (const test::ViewPoint& p : c.points) {
            CAPTURE(c.name);
            CAPTURE(p.at.x);
            CAPTURE(p.w);
            check(view, p);
        }
    }
}

TEST_CASE("the density is how far rays spread as the lens sample moves") {
    from_each_point([](const PupilViewOverTime& view, const test::ViewPoint& p) {
        Random random(13);
        std::vector<double> ratios;
        for (int i = 0; i < 100; ++i) {
            const Vec2f u = square(random) * 0.96f + Vec2f{0.02f, 0.02f};
            const float time = square(random).x, h = 0.002f;
            const auto at = [&](float x, float y) {
                return view.sample(p.at, p.w, {u.x + x, u.y + y}, time);
            };
            const auto s = at(0, 0), a = at(h, 0), b = at(-h, 0), d = at(0, h),
                       e = at(0, -h);
            if (!s || !a || !b || !d || !e) continue;
            const Vec3d z = to_double(s->direction);
            const auto moved = [&](const PupilView::Sample& m,
                                   const PupilView::Sample& n) {
                const Vec3d by =
                    p.w == 0 ? to_double(m.origin) - to_double(n.origin)
                             : to_double(m.direction) - to_double(n.direction);
                return by * (0.5 / h);
            };
            ratios.push_back(std::abs(dot(z, cross(moved(*a, *b), moved(*d, *e)))) *
                             s->pdf);
        }
        check_most(ratios, 0.01);
    });
}

TEST_CASE("what the camera draws lies in the region, seen from any point of its ray") {
    for (const test::ViewCase& c : test::view_cases()) {
        CAPTURE(c.name);
        Random random(5);
        const int count = 100000;
        std::vector<CameraSample> samples(count);
        for (int i = 0; i < count; ++i) {
            const Vec2f u = square(random);
            samples[i] = {
                {c.half_film_mm.x * (2 * u.x - 1), c.half_film_mm.y * (2 * u.y - 1)},
                square(random),
                square(random).x,
                380 + 400 * square(random).x,
                c.opening};
        }
        std::vector<CameraRay> rays(count);
        generate_rays(c.camera, samples, rays);
        const PupilViewOverTime view(c.camera);
        int passed = 0, missed = 0, at_infinity = 0;
        for (int i = 0; i < count; ++i) {
            if (!(rays[i].weight > 0)) continue;
            const double t = 0.1 * std::pow(1e3, square(random).x);
            const Vec3d o = to_double(rays[i].ray.origin),
                        d = to_double(rays[i].ray.direction);
            ++passed;
            missed += !(view.pdf(o + d * t, 1, rays[i].ray) > 0);
            at_infinity += !(view.pdf(d, 0, rays[i].ray) > 0);
        }
        if (std::getenv("VIEW_VERBOSE"))
            std::printf("%-28s missed %d + %d of %d\n", c.name.c_str(), missed,
                        at_infinity, passed);
        CHECK(missed + at_infinity <= passed / 5000);
    }
}

// Estimates the integral with uniform rays toward a disc across the direction to the point.
TEST_CASE("the density integrates to one, and is that of what is drawn") {
    from_each_point([](const PupilViewOverTime& view, const test::ViewPoint& p) {
        Random random(7);
        const Vec3d e = normalize(p.at), x = normalize(cross(Vec3d{0.3, 1, 0.2}, e)),
                    y = cross(e, x);
        Vec3d sum{};
        double reach = 0;
        std::vector<Vec3d> met;
        for (int i = 0; i < 2000; ++i) {
            const float time = square(random).x;
            const auto s = view.sample(p.at, p.w, square(random), time);
            if (!s) continue;
            const Ray ray{
                .origin = s->origin, .direction = s->direction, .time = time};
            CHECK(view.pdf(p.at, p.w, ray) == doctest::Approx(s->pdf).epsilon(1e-4));
            const Vec3d o = to_double(s->origin), d = to_double(s->direction);
            met.push_back(o - d * (dot(o, e) / dot(d, e)));
            sum += met.back();
        }
        REQUIRE(met.size() > 1000);
        const Vec3d middle = sum * (1.0 / double(met.size()));
        for (const Vec3d& q : met) reach = std::max(reach, 1.2 * length(q - middle));
        double total = 0, squares = 0;
        const int count = 40000;
        for (int i = 0; i < count; ++i) {
            const Vec2d u =
                reach * concentric_disc({square(random).x, square(random).y});
            const Vec3d q = middle + x * u.x + y * u.y, way = p.at - p.w * q;
            const double far = length(way), cosine = dot(way, e) / far;
            const Ray ray{.origin = to_float(q),
                          .direction = to_float(way * (1 / far)),
                          .time = square(random).x};
            const double f = view.pdf(p.at, p.w, ray) * kPiD * reach * reach *
                             (p.w == 0 ? 1 : cosine / (far * far));
            total += f, squares += f * f;
        }
        const double mean = total / count;
        CHECK(std::abs(mean - 1) <
              4.5 * std::sqrt((squares / count - mean * mean) / count) + 1e-4);
    });
}
