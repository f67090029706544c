// All forms of surface: hits are on the surface in both directions, and tracing preserves etendue.
#include "optics/lens/surface.h"

#include <doctest/doctest.h>

#include "optics/first_order/paraxial.h"
#include "optics/lens/lens_error.h"
#include "optics/lens/test_lenses.h"
#include "optics/lens/test_shapes.h"
#include "optics/trace/intersect.h"
#include "optics/trace/trace.h"

using namespace dg;

namespace {

LensRay ray_toward(test::Random& u, double z, double reach = 8, double slope = 0.4) {
    const Vec3d at{reach * u(), reach * u(), 0};
    const Vec3d d = normalize(Vec3d{slope * u(), slope * u(), 1});
    return {at + d * (z / d.z), d};
}

/// Largest |J^T Omega J - Omega|.
double symplectic_error(const RayJacobian& j) {
    double worst = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
            double sum = 0;
            for (int i = 0; i < 2; ++i)
                sum += j[i][a] * j[i + 2][b] - j[i + 2][a] * j[i][b];
            const double omega = b == a + 2 ? 1 : a == b + 2 ? -1 : 0;
            worst = std::max(worst, std::abs(sum - omega));
        }
    return worst;
}

template <typename Body>
void for_each_singlet(Body body) {
    test::Random u(7);
    for (int form = 0; form < test::kForms; ++form)
        for (int round = 0; round < 12; ++round) {
            const Prescription lens = test::singlet_of_form(form, u, round % 2 == 1);
            CAPTURE(lens.name);
            body(lens, u);
        }
}

}  // namespace

TEST_CASE("what is met lies on the surface within 1e-9 mm, with the sag's normal") {
    test::Random u(3);
    for (int form = 0; form < test::kForms; ++form) {
        CAPTURE(test::form_name(form));
        int met = 0;
        for (int round = 0; round < 300; ++round) {
            const SurfaceForm f(test::surface_of_form(form, u), 0);
            const int sign = round % 2 ? 1 : -1;
            LensRay ray = ray_toward(u, -30);
            if (sign < 0) ray.direction.z = -ray.direction.z, ray.origin.z = 30;
            const auto hit = meet(f, ray.origin, ray.direction, sign);
            if (!hit) continue;
            ++met;
            const Vec3d p = hit->point, n = hit->normal;
            CHECK(std::abs(sag(f, p.x, p.y).z - p.z) < 1e-9);
            CHECK(length(n) == doctest::Approx(1).epsilon(1e-12));
            CHECK(length(cross(p - ray.origin, ray.direction)) < 1e-10);
            CHECK(hit->cosine == doctest::Approx(sign * dot(n, ray.direction)));
            const double h = 1e-5;  // expected normal, by finite differences of the sag
            const double sx = (sag(f, p.x + h, p.y).z - sag(f, p.x - h, p.y).z) / (2 * h);
            const double sy = (sag(f, p.x, p.y + h).z - sag(f, p.x, p.y - h).z) / (2 * h);
            CHECK(std::abs(n.x / n.z + sx) < 1e-8);
            CHECK(std::abs(n.y / n.z + sy) < 1e-8);
        }
        CHECK(met > 250);
    }
}

TEST_CASE("forms that are the same surface are met at the same point") {
    test::Random u(4);
    for (int round = 0; round < 500; ++round) {
        Surface conic = test::surface_of_form(1, u);
        Surface searched = conic;  // a vanishing asphere forces the iterative search
        searched.asphere = {{4, 1e-300}};
        Surface biconic = conic;
        biconic.shape = Shape::biconic;
        biconic.curvature_x = conic.curvature, biconic.conic_x = conic.conic;
        Surface torus = conic;
        torus.shape = Shape::toroid;
        torus.curvature_x = torus.curvature, torus.conic = 0;
        Surface sphere = torus;
        sphere.shape = Shape::conic, sphere.curvature_x = 0;
        const LensRay ray = ray_toward(u, -20);
        const auto same = [&](const Surface& a, const Surface& b) {
            const auto p = meet(SurfaceForm(a, 0), ray.origin, ray.direction, 1);
            const auto q = meet(SurfaceForm(b, 0), ray.origin, ray.direction, 1);
            REQUIRE(p.has_value() == q.has_value());
            if (!p) return;
            CHECK(length(p->point - q->point) < 1e-11);
            CHECK(length(p->normal - q->normal) < 1e-12);
        };
        same(conic, searched);
        same(conic, biconic);
        same(sphere, torus);
    }
}

TEST_CASE("a sphere written as an asphere of r^2, r^4 ... is that sphere") {
    const double r = 40;
    Surface sphere, series;
    sphere.curvature = 1 / r, sphere.semi_diameter = series.semi_diameter = 8;
    double coefficient = r;  // binomial coefficient of (r^2/R^2)^j in R (1 - sqrt(1 - x))
    for (int j = 1; j <= 12; ++j) {
        coefficient *= j == 1 ? 0.5 : (2 * j - 3) / (2.0 * j);
        series.asphere.push_back({2 * j, coefficient / std::pow(r, 2 * j)});
    }
    test::Random u(5);
    for (int i = 0; i < 300; ++i) {
        const LensRay ray = ray_toward(u, -20, 5);
        const auto p = meet(SurfaceForm(sphere, 0), ray.origin, ray.direction, 1);
        const auto q = meet(SurfaceForm(series, 0), ray.origin, ray.direction, 1);
        REQUIRE((p && q));
        if (std::hypot(p->point.x, p->point.y) > 8) continue;
        CHECK(length(p->point - q->point) < 1e-11);
        CHECK(length(p->normal - q->normal) < 1e-11);
    }
}

TEST_CASE("film -> scene -> film comes back within 1e-9 mm through every form") {
    int passed = 0;
    for_each_singlet([&](const Prescription& lens, test::Random& u) {
        const Tracer t(lens);
        const LensIndices n = t.at(550);
        for (int i = 0; i < 50; ++i) {
            const LensRay in = ray_toward(u, -20, 6, 0.2);
            const auto out = t.to_film(in, n, {});
            if (!out) continue;
            ++passed;
            const auto back =
                t.to_scene({at_plane(out->ray, 60), -out->ray.direction}, n, {});
            REQUIRE(back);
            CHECK(length(at_plane(back->ray, in.origin.z) - in.origin) < 1e-9);
            CHECK(length(back->ray.direction + in.direction) < 1e-11);
            CHECK(length(back->iris - out->iris) < 1e-9);
        }
    });
    CHECK(passed > 2000);
}

TEST_CASE(
    "the analytic Jacobian is symplectic through every form, and that of differences") {
    for_each_singlet([](const Prescription& lens, test::Random& u) {
        const Tracer t(lens);
        const LensIndices n = t.at(550);
        const double after = n.index.back();
        for (int i = 0; i < 20; ++i) {
            const LensRay ray = ray_toward(u, -20, 6, 0.2);
            const auto j = t.jacobian(ray, n, 50);
            if (!j) continue;
            CHECK(symplectic_error(*j) < 1e-10);
            for (int k = 0; k < 4; ++k) {
                const double h = k < 2 ? 1e-4 : 1e-6;
                Vec3d out[2], d[2];
                for (int side = 0; side < 2; ++side) {
                    LensRay moved = ray;
                    const double by = side ? h : -h;
                    if (k < 2) moved.origin[k] += by;
                    if (k >= 2) moved.direction[k - 2] += by;
                    const Vec3d m = moved.direction;
                    moved.direction.z = std::sqrt(1 - m.x * m.x - m.y * m.y);
                    const auto traced = t.to_film(moved, n, {false, nullptr, 0});
                    REQUIRE(traced);
                    out[side] = at_plane(traced->ray, 50),
                    d[side] = traced->ray.direction;
                }
                const Vec3d dp = (out[1] - out[0]) / (2 * h),
                            dd = (d[1] - d[0]) / (2 * h);
                CHECK(std::abs((*j)[0][k] - dp.x) < 2e-6 * (k < 2 ? 1 : 50));
                CHECK(std::abs((*j)[1][k] - dp.y) < 2e-6 * (k < 2 ? 1 : 50));
                CHECK(std::abs((*j)[2][k] - after * dd.x) < 2e-6);
                CHECK(std::abs((*j)[3][k] - after * dd.y) < 2e-6);
            }
        }
    });
}

TEST_CASE("on the axis the Jacobian is the ABCD matrix") {
    for (const Prescription& lens : test::all_lenses()) {
        const Tracer t(lens);
        const FirstOrder f = first_order(lens);
        const auto j = t.jacobian({{0, 0, f.front_focal_z}, {0, 0, 1}},
                                  t.at(f.wavelength_nm), f.back_focal_z);
        REQUIRE(j);
        // Ray matrix between the focal planes: A = D = 0, B = f, C = -1/f.
        for (int axis = 0; axis < 2; ++axis) {
            CHECK(std::abs((*j)[axis][axis]) < 1e-9);
            CHECK(std::abs((*j)[axis + 2][axis + 2]) < 1e-9);
            CHECK((*j)[axis][axis + 2] == doctest::Approx(f.efl).epsilon(1e-10));
            CHECK((*j)[axis + 2][axis] == doctest::Approx(-1 / f.efl).epsilon(1e-10));
        }
    }
}

TEST_CASE("a lens moved as a whole is the same lens for rays that move with it") {
    const Vec3d tilt{7, -4, 20}, shift{1.5, -0.7, 0.3};
    for (int form : {0, 2, 6}) {
        test::Random u(unsigned(30 + form));
        const Prescription still = test::singlet_of_form(form, u, false);
        Prescription moved = still;
        Surface frame_only;
        frame_only.tilt = tilt, frame_only.decenter = shift;
        const SurfaceFrame frame = SurfaceForm(frame_only, 0).place;
        const auto vertices = still.vertices();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const Vec3d vertex{0, 0, vertices[i]};
            moved.surfaces[i].tilt = tilt;
            moved.surfaces[i].decenter = frame.out_of(vertex) - vertex;
        }
        const Tracer a(still), b(moved);
        int passed = 0;
        for (int i = 0; i < 100; ++i) {
            const LensRay ray = ray_toward(u, -20, 6, 0.2);
            const auto p = a.to_film(ray, a.at(550), {});
            const auto q = b.to_film(
                {frame.out_of(ray.origin), frame.turn_out(ray.direction)}, b.at(550), {});
            REQUIRE(p.has_value() == q.has_value());
            if (!p) continue;
            ++passed;
            CHECK(length(frame.out_of(p->ray.origin) - q->ray.origin) < 1e-11);
            CHECK(length(frame.turn_out(p->ray.direction) - q->ray.direction) < 1e-12);
            CHECK(q->optical_path == doctest::Approx(p->optical_path).epsilon(1e-12));
        }
        CHECK(passed > 30);
    }
}

TEST_CASE("the opening of both sides and a central obstruction stop rays") {
    test::Random u(1);
    Prescription lens = test::singlet_of_form(0, u, false);
    const auto passes = [&](double height) {
        const Tracer t(lens);
        return t.to_film({{height, 0, -5}, {0, 0, 1}}, t.at(550), {}).has_value();
    };
    CHECK((passes(0) && passes(6)));
    lens.surfaces[0].semi_diameter_after = 5;
    CHECK((passes(0) && !passes(6)));
    lens.surfaces[0].semi_diameter_after = 0;
    lens.surfaces[0].inner_semi_diameter = 2;
    CHECK((!passes(0) && passes(6)));
    lens.surfaces[0].decenter = {4, 0, 0};
    CHECK((passes(0) && passes(6.5) && !passes(4)));
}

TEST_CASE(
    "beyond the rim of a form there is nothing to meet, and the last of it is met") {
    for (const Shape shape : {Shape::conic, Shape::biconic, Shape::toroid})
        for (const double asphere : {0.0, 1e-9}) {
            Surface s;
            s.shape = shape, s.curvature = s.curvature_x = 1.0 / 20;
            s.asphere = {{4, asphere}};
            const SurfaceForm f(s, 0);
            const auto meets = [&](double height) {
                return meet<double>(f, {0, height, -50}, {0, 0, 1}, 1).has_value();
            };
            CHECK((meets(0) && meets(19.9) && !meets(20.1) && !meets(500)));
        }
}

TEST_CASE("surfaces that cannot be are refused with a code and the surface") {
    const auto refused = [](auto change, const char* code) {
        test::Random u(2);
        Prescription lens = test::singlet_of_form(7, u, false);
        change(lens.surfaces[1]);
        try {
            validate(lens);
            FAIL("not refused");
        } catch (const LensError& e) {
            CHECK(e.code == code);
            CHECK(e.surface == 1);
            CHECK(e.message.find(code) == std::string::npos);
            CHECK(e.what() == e.message + " [" + code + "]");
        }
    };
    const double nan = std::nan("");
    refused([](Surface& s) { s.thickness = -1; }, "lens-overlap");
    refused([&](Surface& s) { s.conic_x = nan; }, "lens-surface");
    refused([&](Surface& s) { s.tilt.y = nan; }, "lens-surface");
    refused([](Surface& s) { s.tilt.x = 90; }, "lens-surface");
    refused([](Surface& s) { s.decenter.x = 1e5; }, "lens-surface");
    refused([](Surface& s) { s.asphere = {{0, 1}}; }, "lens-surface");
    refused([](Surface& s) { s.asphere = {{4, 1e6}}; }, "lens-surface");
    refused([](Surface& s) { s.inner_semi_diameter = 10; }, "lens-surface");
    refused([](Surface& s) { s.semi_diameter_after = -1; }, "lens-surface");
    refused([](Surface& s) { s.curvature_x = 0.2, s.conic_x = 0; }, "lens-surface");
    refused([](Surface& s) { s.shape = Shape::toroid; }, "lens-surface");
    Surface s;
    CHECK_THROWS_AS(set_kind(s, "mirror"), LensError);
}

TEST_CASE("the first crossing of wavy aspheres is that of a dense search") {
    test::Random u(40);
    int compared = 0, missed = 0, several = 0;
    for (int round = 0; round < 1500; ++round) {
        Surface s;
        s.semi_diameter = 10;
        s.curvature = u() / 20;
        for (int power : {3, 4, 6, 8, 10, 14})
            s.asphere.push_back({power, 12 * u() / std::pow(10, power)});
        const SurfaceForm f(s, 0);
        const int sign = round % 2 ? 1 : -1;
        LensRay ray = ray_toward(u, 0, 9, 4);  // up to 80 degrees
        ray.direction.z *= sign;
        const Vec3d d = ray.direction,
                    m = ray.origin - dot(ray.origin, ray.direction) * ray.direction;
        const auto past = [&](double t) {
            const Vec3d p = m + t * d;
            return sign * (p.z - sag(f, p.x, p.y).z);
        };
        // Skip rays outside the clear cylinder.
        const double a = d.x * d.x + d.y * d.y, b = m.x * d.x + m.y * d.y;
        const double root =
            std::sqrt(std::max(0., b * b - a * (m.x * m.x + m.y * m.y - 100)));
        const double low = std::max(-60.0, (-b - root) / a);
        const double high = std::min(60.0, (-b + root) / a);
        constexpr int kSteps = 4000;
        std::optional<double> first;
        int crossings = 0;
        for (int i = 1; i <= kSteps; ++i) {
            const double t0 = low + (high - low) * (i - 1) / kSteps;
            const double t1 = low + (high - low) * i / kSteps;
            if (!(past(t0) < 0 && past(t1) >= 0)) continue;
            ++crossings;
            if (!first) first = t1;
        }
        const auto found = first_crossing(f, m, d, sign);
        if (!first) continue;
        ++compared, several += crossings > 1;
        const bool same =
            found && std::abs(*found - *first) < 1.01 * (high - low) / kSteps;
        missed += !same;
    }
    CHECK(compared > 800);
    CHECK(several > 20);
    CHECK(missed == 0);
}
