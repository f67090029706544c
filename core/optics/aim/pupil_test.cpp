#include "optics/aim/pupil.h"

#include <doctest/doctest.h>

#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

Aim aim_at(const Prescription& lens, double f_stop, double focus_m, bool boxes = false) {
    const Tracer t(lens);
    const FirstOrder f = first_order(lens);
    return make_aim(t, {film_position(lens, f, focus_m), 22, Iris(),
                        iris_radius(lens, f, f_stop),
                        boxes ? PupilDraw::slope_boxes : PupilDraw::aimed});
}

}  // namespace

TEST_CASE("the polynomial's derivative is its slope's") {
    const Aim aim = aim_at(test::wide_angle(), 4, 2);
    const double h = 1e-6;
    for (const double r : {0.0, 0.3, 0.9})
        for (const Vec2d a : {Vec2d{0.1, 0.2}, Vec2d{-0.6, 0.3}, Vec2d{0.0, -0.8}}) {
            const auto m = [&](double x, double y) {
                return aim.slopes.evaluate(r, {x, y}, 0.3).m;
            };
            const Vec2d dx = (m(a.x + h, a.y) - m(a.x - h, a.y)) * (0.5 / h);
            const Vec2d dy = (m(a.x, a.y + h) - m(a.x, a.y - h)) * (0.5 / h);
            CHECK(aim.slopes.evaluate(r, a, 0.3).jacobian ==
                  doctest::Approx(dx.x * dy.y - dx.y * dy.x).epsilon(1e-7));
        }
}

TEST_CASE(
    "terms: the count of the complete basis, and a polynomial is recovered exactly") {
    CHECK(term_count(2) == 11);  // 10 of degree 2 in (s, W, U), and l
    CHECK(term_count(3) == 24);  // 20, and 4 with l
    const Aim aim = aim_at(test::tessar(), 4, 5);
    std::vector<SlopeSample> samples;
    for (int i = 0; i < 400; ++i) {
        const double r = (i * 0.618034) - std::floor(i * 0.618034), phi = i * 2.4;
        const double q = std::sqrt(i * 0.754877 - std::floor(i * 0.754877));
        const double l = 2 * (i * 0.569840 - std::floor(i * 0.569840)) - 1;
        const Vec2d a{q * std::cos(phi), q * std::sin(phi)};
        samples.push_back({r, a, l, aim.slopes.evaluate(r, a, l).m});
    }
    const SlopePolynomial again = fit_slopes(samples, aim.slopes.k);
    for (std::size_t i = 0; i < again.coefficients.size(); ++i)
        CHECK(again.coefficients[i] ==
              doctest::Approx(aim.slopes.coefficients[i]).epsilon(1e-7));
}

TEST_CASE("common lenses are covered without falling back") {
    for (const Prescription& lens : test::all_lenses())
        for (const double stops : {1.0, 2.0, 4.0}) {
            const Aim aim = aim_at(lens, first_order(lens).f_number * stops, 3);
            INFO(lens.name << " at " << stops);
            CHECK(aim.fallback_segments == 0);
            CHECK(aim.tables.degree <= 5);
        }
}

TEST_CASE("exit-pupil boxes serve every radius when asked for") {
    const Aim aim = aim_at(test::check_lens(true, 0.5), 2.8, 3, true);
    CHECK(aim.fallback_segments == kRadialSegments);
    for (int i = 0; i < kRadialSegments; ++i) CHECK(aim.tables.area[i] > 0);
}

TEST_CASE("the same request gives the same coefficients") {
    const Aim a = aim_at(test::fisheye(), 4, 3), b = aim_at(test::fisheye(), 4, 3);
    CHECK(a.slopes.coefficients == b.slopes.coefficients);
    CHECK(std::equal(std::begin(a.tables.column_x), std::end(a.tables.column_x),
                     b.tables.column_x));
}

TEST_CASE("a film far wider than the image circle is lit in its middle only") {
    const Prescription lens = test::tessar();
    const Tracer t(lens);
    const FirstOrder f = first_order(lens);
    const AimRequest request{film_position(lens, f, 3), 3000, Iris(),
                             iris_radius(lens, f, 4)};
    const Aim wide = make_aim(t, request), usual = aim_at(lens, 4, 3);
    CHECK(wide.tables.film_radius > 22);
    CHECK(wide.tables.film_radius < 1000);
    CHECK(usual.tables.film_radius == doctest::Approx(22));
    int drawn = 0;
    for (int i = 0; i < kRadialSegments; ++i)
        drawn += wide.tables.region[i] < 0.5f || wide.tables.area[i] > 0;
    CHECK(drawn > 0);
}
