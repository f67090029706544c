#include "optics/trace/trace.h"

#include <doctest/doctest.h>

#include <array>
#include <random>

#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/lens_path.h"

using namespace dg;

namespace {

using Phase = std::array<double, 4>;  // x, y, n dx, n dy on a plane

/// Transfer from the plane z0 before the lens to the plane z1 behind it.
std::optional<Phase> transfer(const Tracer& t, const LensIndices& n, Phase p, double z0,
                              double z1) {
    const double l = p[2] / n.index.front(), m = p[3] / n.index.front();
    const LensRay ray{{p[0], p[1], z0}, {l, m, std::sqrt(1 - l * l - m * m)}};
    const auto out = t.to_film(ray, n, {false, nullptr, 0});
    if (!out) return std::nullopt;
    const Vec3d at = at_plane(out->ray, z1), d = out->ray.direction;
    return Phase{at.x, at.y, n.index.back() * d.x, n.index.back() * d.y};
}

/// Largest |J^T Omega J - Omega| by central differences. `fault` scales the outgoing momenta.
double symplectic_error(const Tracer& t, const LensIndices& n, Phase p, double z0,
                        double z1, double fault = 1) {
    double jacobian[4][4];
    for (int k = 0; k < 4; ++k) {
        const double h = k < 2 ? 1e-3 : 1e-5;
        Phase a = p, b = p;
        a[k] -= h, b[k] += h;
        const auto fa = transfer(t, n, a, z0, z1), fb = transfer(t, n, b, z0, z1);
        if (!fa || !fb) return 0;
        for (int i = 0; i < 4; ++i)
            jacobian[i][k] = (i < 2 ? 1 : fault) * ((*fb)[i] - (*fa)[i]) / (2 * h);
    }
    double worst = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
            double sum = 0;
            for (int i = 0; i < 2; ++i)
                sum += jacobian[i][a] * jacobian[i + 2][b] -
                       jacobian[i + 2][a] * jacobian[i][b];
            const double omega = b == a + 2 ? 1 : a == b + 2 ? -1 : 0;
            worst = std::max(worst, std::abs(sum - omega));
        }
    return worst;
}

}  // namespace

TEST_CASE("film -> scene -> film comes back within 1e-9 mm") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(-1, 1);
    for (const Prescription& lens : test::all_lenses()) {
        const Tracer t(lens);
        const double film = film_position(lens, first_order(lens), 3);
        const double rear = lens.surfaces.back().semi_diameter;
        int passed = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vec3d from{20 * u(random), 20 * u(random), film};
            const Vec3d to{rear * u(random), rear * u(random), lens.last_vertex()};
            const LensIndices n = t.at(580 + 200 * u(random));
            const auto out = t.to_scene({from, normalize(to - from)}, n, {});
            if (!out) continue;
            ++passed;
            // Move the origin in front of the lens, where rays may start.
            LensRay reverse{out->ray.origin, -out->ray.direction};
            if (reverse.direction.z > 0.2)
                reverse.origin = reverse.origin - 30 * reverse.direction;
            const auto back = t.to_film(reverse, n, {});
            REQUIRE(back);
            const Vec3d there = at_plane(back->ray, film);
            CHECK(length(there - from) < 1e-9);
            CHECK(back->transmittance ==
                  doctest::Approx(out->transmittance).epsilon(1e-12));
            CHECK(length(back->iris - out->iris) < 1e-9);
        }
        CHECK(passed > 50);
    }
}

TEST_CASE("the transfer is symplectic: etendue is kept") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> u(-1, 1);
    for (const Prescription& lens : test::all_lenses()) {
        const Tracer t(lens);
        const FirstOrder f = first_order(lens);
        const LensIndices n = t.at(500);
        for (int i = 0; i < 200; ++i) {
            const double aperture = 0.3 * f.efl / 4;
            const Phase p{aperture * u(random), aperture * u(random), 0.1 * u(random),
                          0.1 * u(random)};
            CHECK(symplectic_error(t, n, p, -1, f.back_focal_z) < 1e-6);
        }
        // Planted fault: momenta 2 % too large, like a wrong refraction.
        CHECK(symplectic_error(t, n, {0, 0, 0, 0}, -1, f.back_focal_z, 1.02) > 0.01);
    }
}

TEST_CASE(
    "a plane plate shifts by d (1 - cos i / (n cos r)); aplanatic points image exactly") {
    const Prescription plate = test::lens_from_rows(
        "plate", {{0, 6, 1.5, 0, 50}, {0, 4, 1, 0, 50}, {0, 0, 1, 0, 50, true}});
    const Tracer t(plate);
    const double s = std::sin(0.5), c = std::cos(0.5), cr = std::sqrt(1 - s * s / 2.25);
    const auto out = t.to_film({{0, 0, 0}, {s, 0, c}}, t.at(550), {});
    REQUIRE(out);
    const double x = at_plane(out->ray, 20).x;
    CHECK(x == doctest::Approx(20 * s / c - 6 * (s / c - s / 1.5 / cr)).epsilon(1e-13));
    // From glass through a sphere of radius r into air: a point r/n beyond the centre
    // images without aberration to n r beyond it (Born and Wolf, 4.2.3).
    const double r = 20, n = 1.6, centre = -r;
    Prescription ball =
        test::lens_from_rows("ball", {{-r, 5, 1, 0, 19.99}, {0, 0, 1, 0, 200, true}});
    ball.object_medium.formula = ConstantIndex{n};
    const Tracer sphere(ball);
    int traced = 0;
    for (double angle = 0.05; angle < 0.9; angle += 0.05) {
        const Vec3d d{std::sin(angle), 0, std::cos(angle)};
        const auto ray = sphere.to_film({{0, 0, centre - r / n}, d}, sphere.at(550), {});
        if (!ray) continue;
        ++traced;
        const Vec3d o = ray->ray.origin;
        const double z = o.z - o.x * ray->ray.direction.z / ray->ray.direction.x;
        CHECK(z == doctest::Approx(centre - n * r).epsilon(1e-11));
    }
    CHECK(traced > 8);
}

TEST_CASE("clear apertures and the iris stop rays; total reflection does") {
    const Prescription lens = test::check_lens();
    const Tracer t(lens);
    const LensIndices n = t.at(550);
    const Iris iris;
    CHECK(t.to_film({{25.3, 0, -10}, {0, 0, 1}}, n, {false, nullptr, 0}));
    CHECK_FALSE(t.to_film({{25.3, 0, -10}, {0, 0, 1}}, n, {}));
    const auto passed = t.to_film({{10, 0, -10}, {0, 0, 1}}, n, {true, &iris, 17});
    REQUIRE(passed);
    const double at_stop = passed->iris.x;
    CHECK(t.to_film({{10, 0, -10}, {0, 0, 1}}, n, {true, &iris, at_stop * 1.0001}));
    CHECK_FALSE(t.to_film({{10, 0, -10}, {0, 0, 1}}, n, {true, &iris, at_stop * 0.9999}));
    const Prescription plate =
        test::lens_from_rows("plate", {{0, 5, 1, 0, 50}, {0, 5, 1, 0, 50, true}});
    Prescription glass = plate;
    glass.object_medium.formula = ConstantIndex{1.5};
    const Tracer inside(glass);
    CHECK_FALSE(inside.to_film({{0, 0, -1}, {std::sin(0.8), 0, std::cos(0.8)}},
                               inside.at(550), {}));
    CHECK(inside.to_film({{0, 0, -1}, {std::sin(0.7), 0, std::cos(0.7)}}, inside.at(550),
                         {}));
}

TEST_CASE("an iris within the bulge of its neighbour passes light, and mirrored light, by any path") {
    const Prescription lens = test::lens_from_rows("bulge", {{40, 3, 1.6, 0, 12},
                                                             {25, 0.8, 1, 0, 10},
                                                             {0, 3, 1, 0, 9, true},
                                                             {60, 3, 1.6, 0, 12},
                                                             {-60, 40, 1, 0, 12}});
    const Tracer t(lens);
    const LensIndices n = t.at(550);
    const LensPath straight = straight_path(5, true), ghost = ghost_path(5, 3, 4, true);
    for (double y = 0; y < 8; y += 0.5) {
        const LensRay ray{{0, y, -5}, {0, 0, 1}};
        const auto plain = t.to_film(ray, n, {});
        REQUIRE(plain);
        TracedRay traced{ray};
        CHECK(t.follow(traced, straight, n, {}) == -1);
        CHECK(traced.ray.origin.y == plain->ray.origin.y);
        traced = TracedRay{ray};
        CHECK(t.follow(traced, ghost, n, {}) == -1);
    }
}

TEST_CASE("random prescriptions and rays give points or nothing, never NaN") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-1, 1);
    int traced = 0;
    for (int round = 0; round < 2000; ++round) {
        Prescription lens;
        lens.name = "random";
        const int count = 1 + int(6 * (u(random) + 1));
        for (int i = 0; i < count; ++i) {
            Surface s;
            s.curvature = u(random) < -0.6 ? 0 : 0.3 * u(random) * u(random);
            s.thickness = 10 * std::abs(u(random));
            s.semi_diameter =
                s.curvature == 0 ? 20 : std::min(20.0, 1 / std::abs(s.curvature));
            if (i % 2 == 0)
                s.glass.formula = AbbeGlass{1.75 + 0.25 * u(random), 45 + 20 * u(random)};
            lens.surfaces.push_back(s);
        }
        lens.surfaces[std::size_t((u(random) + 1) * 0.499 * count)].stop = true;
        const Tracer t(lens);
        const LensIndices n = t.at(580 + 200 * u(random));
        for (int i = 0; i < 20; ++i) {
            const Vec3d o{15 * u(random), 15 * u(random), -20 * (u(random) + 1)};
            const Vec3d d =
                normalize(Vec3d{u(random), u(random), 0.01 + std::abs(u(random))});
            for (const auto& ray :
                 {t.to_film({o, d}, n, {}), t.to_scene({{o.x, o.y, 200}, -d}, n, {})}) {
                if (!ray) continue;
                ++traced;
                CHECK(std::isfinite(ray->ray.origin.x + ray->ray.origin.y +
                                    ray->ray.origin.z));
                CHECK(length(ray->ray.direction) == doctest::Approx(1).epsilon(1e-9));
                CHECK(ray->transmittance > 0);
                CHECK(ray->transmittance <= 1);
            }
        }
    }
    CHECK(traced > 1000);
}

TEST_CASE("glass swallows along the path; a surface's own coating comes first") {
    Prescription plate;
    const Glass dark{ConstantIndex{1.5}, "", {{400, 600}, {0.04, 0.02}}};
    plate.surfaces = {{0, 10, 20, dark}, {0, 50, 20, {}, true}};
    plate.coating = Coating::perfect;
    const double sine = 0.6;
    const LensRay ray{{0, 0, -5}, {sine, 0, 0.8}};
    const auto share = [&](double nm) {
        const Tracer t(plate);
        return t.to_film(ray, t.at(nm), {})->transmittance;
    };
    const double path = 10 / std::sqrt(1 - sine * sine / 2.25);
    CHECK(share(500) == doctest::Approx(std::exp(-0.03 * path)).epsilon(1e-12));
    CHECK(share(380) == doctest::Approx(std::exp(-0.04 * path)).epsilon(1e-12));
    plate.surfaces[1].coating = "uncoated";
    const double bare = surface_transmittance({}, 1.5, std::sqrt(1 - 0.16), 1, 0.8, 500);
    CHECK(share(500) == doctest::Approx(bare * std::exp(-0.03 * path)).epsilon(1e-12));
}
