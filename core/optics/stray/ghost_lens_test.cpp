#include "optics/stray/ghost_lens.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <random>

#include "math/error.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"
#include "optics/lens/test_shapes.h"
#include "optics/trace/test_targets.h"

using namespace dg;

namespace {

GhostLens ghosts_of(const Prescription& lens, const SensorStack& stack = {}, const Iris& iris = {},
                    double open = 1) {
    const FirstOrder order = first_order(lens);
    const double film = film_position(lens, order, std::numeric_limits<double>::infinity(), FocusFrom::pupil);
    return {lens, {{0, 0, film}}, iris, open * order.stop_semi_diameter, stack, 21.6};
}

/// Biconvex lens with the stop close behind it.
Prescription singlet(double semi_diameter = 5) {
    return test::lens_from_rows("singlet", {{50, 6, 1.5168, 0, semi_diameter},
                                            {-80, 1, 1, 0, semi_diameter},
                                            {0, 0, 1, 0, semi_diameter, true}});
}

/// Ray in roughly one direction, over a disc at the first vertex.
LensRay random_ray(std::mt19937& rng, double radius, double slope) {
    std::uniform_real_distribution<double> u(-1, 1);
    return {{radius * u(rng), radius * u(rng), 0},
            normalize(Vec3d{slope * u(rng), slope * u(rng), 1})};
}

struct Batch {
    SceneRays scene;
    FilmRays film;
    alignas(64) float opening[kLensBatch];

    void set(int i, const LensRay& ray, double nm) {
        scene.x[i] = float(ray.origin.x), scene.y[i] = float(ray.origin.y);
        scene.z[i] = float(ray.origin.z), scene.dx[i] = float(-ray.direction.x);
        scene.dy[i] = float(-ray.direction.y), scene.dz[i] = float(-ray.direction.z);
        film.nm[i] = float(nm);
    }
    LensRay ray(int i) const {
        return {{scene.x[i], scene.y[i], scene.z[i]},
                normalize(Vec3d{-scene.dx[i], -scene.dy[i], -scene.dz[i]})};
    }
};

/// Ghost ray at the film from the scalar tracer; transmittance 0 if it is clipped.
struct Landing {
    Vec2d at{};
    double pass = 0;
    Vec2d iris{};
};
Landing land(const GhostLens& lens, const Mirrors& mirrors, const LensRay& ray, double nm,
             double widened = 1) {
    Clip clip = lens.clip();
    clip.widened = widened, clip.iris_radius *= widened;
    TracedRay traced{ray};
    if (lens.tracer().follow(traced, lens.path(mirrors), lens.tracer().at(nm), clip) >= 0) return {};
    if (!(traced.ray.direction.z > 0)) return {};
    const Vec3d p = at_plane(traced.ray, lens.film().center.z);
    return {{p.x, p.y}, traced.transmittance, traced.iris};
}

double normal_reflectance(double n1, double n2) {
    return (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2));
}

}  // namespace

TEST_CASE("n reflecting surfaces have n (n - 1) / 2 ghosts") {
    for (const Prescription& lens : test::all_lenses()) {
        const std::size_t n = lens.surfaces.size() - 1;   // all surfaces but the stop
        INFO(lens.name);
        CHECK(ghosts_of(lens).two_bounces().size() == n * (n - 1) / 2);
        const SensorStack stack{.cover_thickness = 2, .cover_gap = 1, .reflectance = 0.1};
        CHECK(ghosts_of(lens, stack).two_bounces().size() == (n + 3) * (n + 2) / 2);
    }
    Prescription perfect = test::tessar();
    perfect.coating = Coating::perfect;
    CHECK(ghosts_of(perfect).two_bounces().empty());
}

TEST_CASE("a path by mirrors turns at each of them and leaves through all surfaces") {
    const std::vector<int> four{5, 2, 4, 1};
    const LensPath path = ghost_path(7, four, true);
    int at = 0;
    std::vector<int> turned;
    for (const PathStep& s : path) {
        CHECK(s.surface == at);
        if (s.reflects) turned.push_back(s.surface);
        at += s.reflects ? -s.sign : s.sign;
    }
    CHECK(at == 7);
    CHECK(turned == four);
}

TEST_CASE("ghosts by four reflections are all sequences that turn each time, brightest first") {
    const GhostLens ghosts = ghosts_of(test::tessar());
    const std::size_t n = ghosts.reflecting().size();
    std::size_t count = 0;   // order: far, near, far, near
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < a; ++b)
            for (std::size_t c = b + 1; c < n; ++c) count += c;
    const auto all = ghosts.four_bounces(1 << 20);
    CHECK(all.size() == count);
    CHECK(ghosts.four_bounces(10).size() == 10);
    double last = 1;
    for (const Mirrors& m : all) {
        double r = 1;
        for (const int i : m) r *= ghosts.reflectance(i);
        CHECK(r <= last * (1 + 1e-12));
        last = r;
    }
}

TEST_CASE("the ghost of a single lens is where matrices have it, as large, and as bright") {
    // First-order trace, as the pupil is small. y: height; v: dy along the path. A surface of
    // curvature c refracts light along +z by n' v' = n v - (n' - n) c y, and reflects it to v + 2 c
    // y; it reflects light along -z to v - 2 c y.
    const Prescription lens = singlet(0.3);
    const GhostLens ghosts = ghosts_of(lens);
    REQUIRE(ghosts.two_bounces() == std::vector<Mirrors>{{1, 0}});
    const double n = 1.5168, c1 = 1.0 / 50, c2 = -1.0 / 80, d = 6;
    double y = 0.25, v = -(n - 1) * c1 * y / n;
    y += d * v, v += 2 * c2 * y;
    y += d * v, v -= 2 * c1 * y;
    y += d * v, v = n * v - (1 - n) * c2 * y;
    const double film = ghosts.film().center.z;
    const double want = y + v * (film - d);
    const Landing got = land(ghosts, {1, 0}, {{0, 0.25, 0}, {0, 0, 1}}, 587.56);
    REQUIRE(got.pass > 0);
    CHECK(got.at.y == doctest::Approx(want).epsilon(0.01));
    // Focus of the ghost: where its light crosses the axis.
    TracedRay ray{{{0, 0.25, 0}, {0, 0, 1}}};
    REQUIRE(ghosts.tracer().follow(ray, ghosts.path({1, 0}), ghosts.tracer().at(587.56), ghosts.clip()) < 0);
    const double focus = ray.ray.origin.z - ray.ray.origin.y * ray.ray.direction.z / ray.ray.direction.y;
    CHECK(focus == doctest::Approx(d - y / v).epsilon(0.01));
}

TEST_CASE("on the axis the light of a ghost is the product of its surfaces by the textbook") {
    Prescription lens = singlet();
    const double r = normal_reflectance(1, 1.5168);
    CHECK(r == doctest::Approx(0.0422).epsilon(0.0001));
    lens.coating = Coating::uncoated;
    const GhostLens bare = ghosts_of(lens);
    CHECK(land(bare, {1, 0}, {{}, {0, 0, 1}}, 550).pass / ((1 - r) * r * r * (1 - r)) ==
          doctest::Approx(1).epsilon(1e-6));
    lens.coating = Coating::mgf2;   // quarter wave at 550 nm: R = ((n1^2 - n) / (n1^2 + n))^2
    const double amplitude = (1.38 * 1.38 - 1.5168) / (1.38 * 1.38 + 1.5168), q = amplitude * amplitude;
    CHECK(q == doctest::Approx(0.0128).epsilon(0.0002));
    const GhostLens coated = ghosts_of(lens);
    CHECK(land(coated, {1, 0}, {{}, {0, 0, 1}}, 550).pass / ((1 - q) * q * q * (1 - q)) ==
          doctest::Approx(1).epsilon(1e-6));
    // Sensor with cover glass: ghost between the sensor and the last surface of the lens.
    const GhostLens stack = ghosts_of(lens, {.cover_thickness = 2, .cover_index = 1.5,
                                             .cover_coating = Coating::uncoated, .reflectance = 0.1});
    const double g = normal_reflectance(1, 1.5), t = (1 - g) * (1 - g);
    CHECK(land(stack, {5, 1}, {{}, {0, 0, 1}}, 550).pass / ((1 - q) * (1 - q) * t * 0.1 * t * q * t) ==
          doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("lanes trace ghosts as the reference does, on every target") {
    std::vector<Prescription> lenses = test::all_lenses();
    lenses.resize(4);
    lenses[1].coating = Coating::broadband, lenses[2].coating = Coating::v_coat;
    lenses[3].coating = Coating::uncoated;
    lenses.push_back(singlet());
    lenses[4].surfaces[1].thickness = 0.02;   // iris within the bulge of the glass
    lenses[4].surfaces[1].curvature = 1.0 / 80;
    const auto batch = std::make_unique<Batch>();
    test::for_each_target([&] {
        std::mt19937 rng(7);
        int passed = 0, differ = 0, rays = 0;
        for (const Prescription& lens : lenses) {
            const GhostLens ghosts =
                ghosts_of(lens, {.cover_thickness = 2, .reflectance = 0.2}, Iris::polygon(6, 10, 0.3), 0.7);
            const double radius = lens.surfaces[0].semi_diameter;
            for (const Mirrors& mirrors : ghosts.two_bounces()) {
                for (int i = 0; i < kLensBatch; ++i)
                    batch->set(i, random_ray(rng, 0.4 * radius, 0.15), 400 + 1.3 * i);
                trace_ghost(ghosts, ghosts.steps(mirrors), batch->scene, batch->film, nullptr, kLensBatch);
                for (int i = 0; i < kLensBatch; i += 8) {
                    ++rays;
                    const double nm = batch->film.nm[i], got = batch->scene.pass[i];
                    const Landing want = land(ghosts, mirrors, batch->ray(i), nm);
                    if ((want.pass > 0) != (got > 0)) {   // near an edge, slightly larger and smaller apertures
                                                          // disagree
                        const double wide = land(ghosts, mirrors, batch->ray(i), nm, 1 + 1e-4).pass,
                                     narrow = land(ghosts, mirrors, batch->ray(i), nm, 1 - 1e-4).pass;
                        differ += (wide > 0) == (narrow > 0);
                        continue;
                    }
                    if (!(got > 0)) continue;
                    ++passed;
                    const double far = length(want.at) + 20;
                    CHECK(std::hypot(batch->film.x[i] - want.at.x, batch->film.y[i] - want.at.y) < 3e-4 * far);
                    CHECK(got / want.pass == doctest::Approx(1).epsilon(2e-3));
                }
            }
        }
        CHECK(passed > 1000);
        CHECK(differ <= rays / 2000);
    });
}

TEST_CASE("a leaf shutter in the iris stops ghosts at each crossing") {
    const GhostLens ghosts = ghosts_of(test::tessar());
    const auto batch = std::make_unique<Batch>();
    std::mt19937 rng(3);
    int stopped = 0;
    for (const Mirrors& mirrors : ghosts.two_bounces()) {
        const auto set = [&](float opening) {
            std::mt19937 same(5);
            for (int i = 0; i < kLensBatch; ++i) {
                batch->set(i, random_ray(same, 6, 0.1), 550);
                batch->opening[i] = opening;
            }
        };
        set(0.4f);
        trace_ghost(ghosts, ghosts.steps(mirrors), batch->scene, batch->film, batch->opening, kLensBatch);
        std::vector<float> leaf(batch->scene.pass, batch->scene.pass + kLensBatch);
        // Equal to an iris set to 0.4 of the radius.
        const GhostLens small = ghosts_of(test::tessar(), {}, {}, 0.4);
        set(1);
        trace_ghost(small, small.steps(mirrors), batch->scene, batch->film, batch->opening, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) {
            const bool same = (leaf[i] > 0) == (batch->scene.pass[i] > 0);
            stopped += leaf[i] == 0;
            CHECK(same);
        }
    }
    CHECK(stopped > 1000);
}

TEST_CASE("light that enters a lens is imaged, mirrored twice or more, sent back, swallowed or stopped") {
    // Reference: a random walk that reflects with probability R at each surface. Its share of light
    // at the film after two reflections must equal the sum of all ghosts, and all shares must sum
    // to one.
    Prescription lens = test::tessar();
    lens.coating = Coating::uncoated;
    const GhostLens ghosts = ghosts_of(lens);
    const Tracer& tracer = ghosts.tracer();
    const LensIndices n = tracer.at(550);
    std::mt19937 rng(11);
    std::uniform_real_distribution<double> u(0, 1);
    const int kRays = 60000;
    double imaged = 0, twice = 0, more = 0, back = 0, stopped = 0;
    double straight = 0, of_ghosts = 0, squares = 0;
    for (int i = 0; i < kRays; ++i) {
        const LensRay start = random_ray(rng, 8, 0.1);
        TracedRay walk{start};
        int at = 0, sign = 1, mirrors = 0;
        for (;;) {
            TracedRay through = walk, mirrored = walk;
            through.transmittance = mirrored.transmittance = 1;
            const bool passes = tracer.follow(through, LensPath{{at, sign}}, n, ghosts.clip()) < 0;
            const bool reflects = tracer.follow(mirrored, LensPath{{at, sign, true}}, n, ghosts.clip()) < 0;
            if (!passes && !reflects) { ++stopped; break; }
            if (passes && reflects) CHECK(through.transmittance + mirrored.transmittance == doctest::Approx(1));
            const bool turn = reflects && u(rng) < mirrored.transmittance;
            if (!turn && !passes) { ++stopped; break; }
            walk = turn ? mirrored : through;
            if (turn) sign = -sign, ++mirrors;
            at += sign;
            if (at < 0) { ++back; break; }
            if (at == ghosts.passed()) {
                (mirrors == 0 ? imaged : mirrors == 2 ? twice : more) += 1;
                break;
            }
        }
        TracedRay direct{start};
        if (tracer.follow(direct, straight_path(ghosts.passed(), true), n, ghosts.clip()) < 0)
            straight += direct.transmittance;
        double sum = 0;
        for (const Mirrors& m : ghosts.two_bounces()) {
            TracedRay traced{start};
            if (tracer.follow(traced, ghosts.path(m), n, ghosts.clip()) < 0) sum += traced.transmittance;
        }
        of_ghosts += sum, squares += sum * sum;
    }
    CHECK(imaged + twice + more + back + stopped == kRays);
    const auto close = [&](double count, double expected) {
        return std::abs(count - expected) < 4 * std::sqrt(expected + 1);
    };
    CHECK(close(imaged, straight));
    CHECK(close(twice, of_ghosts));
    CHECK(of_ghosts > 100);
    CHECK(more < 0.2 * twice);
    CHECK(back > 0.1 * kRays);   // uncoated: six surfaces of 5 to 6 %
}

TEST_CASE("a body that cannot be is refused") {
    const Prescription lens = test::tessar();
    CHECK_THROWS_WITH_AS(ghosts_of(lens, {.reflectance = 1.2}), doctest::Contains("more light than arrives"),
                         Error);
    CHECK_THROWS_WITH_AS(ghosts_of(lens, {.cover_thickness = 60}), doctest::Contains("behind the lens"), Error);
    CHECK_THROWS_AS(ghosts_of(lens, {.cover_thickness = 1, .cover_index = 0.5}), Error);
}
