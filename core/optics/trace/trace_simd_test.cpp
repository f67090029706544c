#include "optics/trace/trace_simd.h"

#include <doctest/doctest.h>

#include <memory>
#include <random>

#include "optics/aim/pupil.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"
#include "optics/lens/test_shapes.h"
#include "optics/trace/test_targets.h"

using namespace dg;

namespace {

std::vector<Iris> irises() {
    return {Iris(), Iris::polygon(5, 20, 0), Iris::polygon(7, 3, 0.7),
            Iris::polygon(6, 0, -0.5), Iris::image(3, 3, {0, 1, 0, 1, 0.5f, 1, 0, 1, 0})};
}

struct Bench {
    std::unique_ptr<FilmRays> film = std::make_unique<FilmRays>();
    std::unique_ptr<SceneRays> scene = std::make_unique<SceneRays>();
    std::unique_ptr<LensSamples> samples = std::make_unique<LensSamples>();
};

/// Whether a ray grazes an edge (within 1e-5 mm in float), so that the scalar and the SIMD tracer
/// may disagree on clipping.
bool grazes(const Tracer& t, const LensRay& ray, const LensIndices& n, const Iris& iris,
            double r) {
    const double step = 3e-5 * r;
    const auto wide = t.to_scene(ray, n, {true, nullptr, 0, 1 + 3e-5});
    const auto narrow = t.to_scene(ray, n, {true, nullptr, 0, 1 - 3e-5});
    if (wide.has_value() != narrow.has_value()) return true;
    if (!wide) return false;
    const double here = iris.transmission(wide->iris * (1 / r));
    for (const Vec2d d :
         {Vec2d{step, 0}, Vec2d{-step, 0}, Vec2d{0, step}, Vec2d{0, -step}})
        if (iris.transmission((wide->iris + d) * (1 / r)) != here) return true;
    return false;
}

}  // namespace

namespace {

/// Lens with the film's position, for traces in both directions.
struct Case {
    Prescription lens;
    double film_z, size, iris_radius;  // size: focal length, or a comparable length
};

std::vector<Case> patent_lenses() {
    std::vector<Case> cases;
    for (const Prescription& lens : test::all_lenses()) {
        const FirstOrder f = first_order(lens);
        cases.push_back(
            {lens, film_position(lens, f, 4), f.efl, 0.8 * f.stop_semi_diameter});
    }
    return cases;
}

/// Lenses in which every other glass absorbs, mostly blue; they cycle through the coating presets.
std::vector<Case> lenses_of_dark_glass() {
    constexpr Coating presets[] = {Coating::broadband, Coating::v_coat, Coating::uncoated};
    std::vector<Case> cases = patent_lenses();
    for (std::size_t k = 0; k < cases.size(); ++k) {
        Prescription& lens = cases[k].lens;
        lens.coating = presets[k % 3];
        lens.surfaces[0].coating = "mgf2";
        for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
            if (i % 2 == 0 && !is_air(lens.surfaces[i].glass))
                lens.surfaces[i].glass.absorption = {{380, 400, 500, 700},
                                                     {0.03, 0.012, 0.002, 0.001}};
    }
    return cases;
}

std::vector<Case> singlets_of_every_form() {
    std::vector<Case> cases;
    test::Random u(21);
    for (int form = 0; form < test::kForms; ++form)
        for (bool placed : {false, true})
            cases.push_back({test::singlet_of_form(form, u, placed), 50, 50, 7});
    return cases;
}

void aim_at_the_rear(const Case& c, test::Random& u, FilmRays& film) {
    const double rear = c.lens.surfaces.back().semi_diameter;
    const double gap = c.film_z - c.lens.last_vertex();
    for (int i = 0; i < kLensBatch; ++i) {
        film.x[i] = float(15 * u()), film.y[i] = float(12 * u());
        film.mx[i] = float(-(rear * u() - film.x[i]) / gap);
        film.my[i] = float(-(rear * u() - film.y[i]) / gap);
        film.nm[i] = float(580 + 200 * u());
    }
}

/// Traces film -> scene -> film in lanes, and film -> scene with the reference. Returns the number
/// of rays that pass.
int compare_lanes(const Case& c, const Iris& iris, test::Random& u) {
    Bench b;
    const Tracer t(c.lens);
    const LensTables tables = make_lens_tables(t, c.film_z, true, &iris, c.iris_radius);
    aim_at_the_rear(c, u, *b.film);
    const FilmRays start = *b.film;
    trace_to_scene(tables, *b.film, *b.scene, kLensBatch);
    const SceneRays out = *b.scene;
    trace_to_film(tables, *b.scene, *b.film, kLensBatch);
    int passed = 0;
    for (int i = 0; i < kLensBatch; ++i) {
        const LensIndices n = t.at(start.nm[i]);
        const LensRay ray{{start.x[i], start.y[i], c.film_z},
                          normalize(Vec3d{-start.mx[i], -start.my[i], -1})};
        const auto exact = t.to_scene(ray, n, {true, &iris, c.iris_radius});
        if ((out.pass[i] > 0) != exact.has_value()) {
            CHECK(grazes(t, ray, n, iris, c.iris_radius));
            continue;
        }
        if (!exact) continue;
        ++passed;
        const Vec3d d{out.dx[i], out.dy[i], out.dz[i]}, o{out.x[i], out.y[i], out.z[i]};
        CHECK(length(d - exact->ray.direction) < 4e-6);
        CHECK(length(o - exact->ray.origin) < 2e-6 * c.size + 2e-5);
        CHECK(out.pass[i] == doctest::Approx(exact->transmittance).epsilon(3e-4));
        CHECK(length(Vec2d{out.iris_x[i], out.iris_y[i]} - exact->iris) < 1e-4);
        // The round trip ends at the same film point, unless the ray grazes an edge.
        if (b.scene->pass[i] > 0) {
            CHECK(std::abs(b.film->x[i] - start.x[i]) < 2e-5 * c.size + 2e-4);
            CHECK(std::abs(b.film->mx[i] - start.mx[i]) < 2e-5);
        } else {
            CHECK(grazes(t, ray, n, iris, c.iris_radius));
        }
    }
    return passed;
}

}  // namespace

TEST_CASE("lanes lose what coatings reflect and glass swallows, as the reference does") {
    test::for_each_target([] {
        test::Random u(12);
        for (const Case& c : lenses_of_dark_glass()) CHECK(compare_lanes(c, Iris(), u) > 3);
    });
}

TEST_CASE("lanes equal the scalar reference on every target, both directions") {
    test::for_each_target([] {
        test::Random u(11);
        for (const Case& c : patent_lenses())
            for (const Iris& iris : irises()) CHECK(compare_lanes(c, iris, u) > 3);
    });
}

TEST_CASE(
    "lanes equal the scalar reference for surfaces of every form, moved and turned") {
    test::for_each_target([] {
        test::Random u(12);
        for (const Case& c : singlets_of_every_form()) {
            CAPTURE(c.lens.name);
            CHECK(compare_lanes(c, Iris(), u) > 40);
        }
    });
}

TEST_CASE(
    "drawn slopes, weights and Jacobians equal the double polynomial on every target") {
    const Prescription lens = test::check_lens(true, 0.5);
    const Tracer t(lens);
    const FirstOrder f = first_order(lens);
    for (const Iris& iris : irises()) {
        const AimRequest request{film_position(lens, f, 2), 21.6, iris,
                                 iris_radius(lens, f, 4)};
        const Aim aim = make_aim(t, request);
        const LensTables tables =
            make_lens_tables(t, request.film_z, true, &iris, request.iris_radius);
        test::for_each_target([&] {
            std::mt19937 random(3);
            std::uniform_real_distribution<float> u(0, 1);
            Bench b;
            alignas(64) float weight[kLensBatch], again[kLensBatch];
            for (int i = 0; i < kLensBatch; ++i) {
                b.samples->x[i] = 36 * u(random) - 18,
                b.samples->y[i] = 24 * u(random) - 12;
                b.samples->u[i] = u(random), b.samples->v[i] = u(random);
                b.samples->nm[i] = 380 + 400 * u(random);
            }
            guided_rays(tables, aim.tables, *b.samples, *b.scene, weight, b.film.get(),
                        kLensBatch);
            aim_weights(tables, aim.tables, *b.film, *b.scene, again, kLensBatch);
            int compared = 0;
            for (int i = 0; i < kLensBatch; ++i) {
                const double r =
                    std::hypot(b.samples->x[i], b.samples->y[i]) / aim.tables.film_radius;
                const int segment = std::min(63, int(r * kRadialSegments));
                if (aim.tables.region[segment] > 0) continue;
                ++compared;
                const double c = b.samples->x[i] / (r * aim.tables.film_radius);
                const double s = b.samples->y[i] / (r * aim.tables.film_radius);
                const Vec2d a =
                    (request.iris_radius / aim.tables.iris_scale) *
                    iris.sample({b.samples->u[i], b.samples->v[i]}, aim.tables.enlargement);
                const SlopeValue v =
                    aim.slopes.evaluate(r, {c * a.x + s * a.y, c * a.y - s * a.x},
                                        tables.scale(b.samples->nm[i]));
                CHECK(std::abs(b.film->mx[i] - (c * v.m.x - s * v.m.y)) < 3e-6);
                CHECK(std::abs(b.film->my[i] - (s * v.m.x + c * v.m.y)) < 3e-6);
                const double one_m2 = 1 + dot(v.m, v.m);
                const double expected =
                    aim.tables.shape_area * std::abs(v.jacobian) / (one_m2 * one_m2);
                CHECK(weight[i] == doctest::Approx(expected).epsilon(2e-5));
                // Weight that reprojection finds from the traced ray alone.
                if (b.scene->pass[i] > 0)
                    CHECK(again[i] == doctest::Approx(weight[i]).epsilon(2e-4));
            }
            CHECK(compared > 100);
        });
    }
}

TEST_CASE("one vector of tail: a batch's rays do not depend on their lane") {
    const Prescription lens = test::check_lens(true, 0.5);
    const Tracer t(lens);
    const LensTables tables =
        make_lens_tables(t, lens.last_vertex() + 36, true, nullptr, 0);
    Bench b;
    for (int i = 0; i < kLensBatch; ++i) {
        b.film->x[i] = 3, b.film->y[i] = -2, b.film->mx[i] = 0.05f, b.film->my[i] = 0.02f;
        b.film->nm[i] = 510;
    }
    trace_to_scene(tables, *b.film, *b.scene, kLensBatch);
    for (int i = 1; i < kLensBatch; ++i) {
        CHECK(b.scene->dx[i] == b.scene->dx[0]);
        CHECK(b.scene->x[i] == b.scene->x[0]);
        CHECK(b.scene->pass[i] == b.scene->pass[0]);
    }
}
