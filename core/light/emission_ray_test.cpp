// Rays that leave emitters: their total power, and their densities.
#include "light/emission_ray.h"

#include <doctest/doctest.h>

#include "light/direction_test.h"
#include "math/error.h"

using namespace dg;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Vec2f pair(int seed, int i) {
    return {float(hash_uniform(seed, 2 * i)), float(hash_uniform(seed, 2 * i + 1))};
}

const Sphere kScene{{0.5f, 0, -1}, 3}, kAll{{0, 0, 0}, 8};
const std::vector<Sphere> kBalls{{{1.5f, 0, 0}, 0.4f}, {{0, -1, 1}, 0.2f}};

EmissionReach reach(bool aimed) {
    return {kScene, kAll, aimed ? EmissionAim(kBalls) : EmissionAim()};
}

LightSet set_of(std::vector<Light> lights) { return LightSet(std::move(lights), std::nullopt); }

/// Moments of value / pdf; the mean is the flux of the red channel, lm.
SampleMoments flux(const EmissionRays& rays, int n = 40000) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        const auto ray = rays.sample(float(hash_uniform(1, i)), pair(2, i), pair(3, i), 0.5f);
        values.push_back(ray ? ray->value.x / ray->pdf : 0.0);
    }
    return moments(values);
}

bool agrees(const SampleMoments& m, double expected) {
    return std::abs(m.mean - expected) < 4 * std::sqrt(m.variance / m.count) + 1e-5 * expected;
}

TriangleLight triangle(bool two_sided) {
    return {{0, 0, 0}, {0.3f, 0, 0.1f}, {0, 0.2f, 0.2f}, {2, 2, 2}, 0, 0, two_sided, false, true};
}
double area(const TriangleLight& t) { return 0.5 * length(cross(t.b - t.a, t.c - t.a)); }

/// An asymmetric sky with one bright texel.
Environment sky() {
    EnvironmentImage image{16, 8, std::vector<Rgb>(128, Rgb{0.5f, 0.5f, 0.5f})};
    image.pixels[16 * 2 + 5] = {300, 300, 300};
    return Environment::image(image, 1, {});
}

}  // namespace

TEST_CASE("the flux of all rays is the known power of the lamp, aimed or not") {
    for (const bool aimed : {false, true}) {
        const auto power = [&](Light light) {
            const LightSet set = set_of({light});
            return flux(EmissionRays(set, reach(aimed)));
        };
        CHECK(agrees(power(PointLight{{0, 1, 0}, {2, 2, 2}}), 4 * kPiD * 2));
        const double r = 0.25;
        const auto sphere = power(SphereLight{{{0, 1, 0}, float(r)}, {2, 2, 2}});
        CHECK(agrees(sphere, kPiD * 2 * 4 * kPiD * r * r));
        CHECK_FALSE(agrees(sphere, 1.04 * kPiD * 2 * 4 * kPiD * r * r));
        for (const bool both : {false, true})
            CHECK(agrees(power(triangle(both)), (both ? 2 : 1) * kPiD * 2 * area(triangle(both))));
        // Between the two cone angles the attenuation is the square of a linear function of the cosine.
        const double inner = std::cos(0.3), outer = std::cos(0.6);
        CHECK(agrees(power(SpotLight{{0, 1, 0}, {0, -1, 0}, {2, 2, 2}, 0.3f, 0.6f}),
                     2 * 2 * kPiD * (1 - inner + (inner - outer) / 3)));
        CHECK(agrees(power(DirectionalLight{{0, -1, 0}, {2, 2, 2}}), 2 * kPiD * 9));
        // The total flux of a disc exceeds the flux onto a facing surface: L 2 pi (1 - cos) against pi L sin^2.
        for (const double angle : {0.01, 1.0, kPiD})
            CHECK(agrees(power(DirectionalLight{{0, -1, 0}, {2, 2, 2}, float(angle)}),
                         2 * 2 / (1 + std::cos(angle / 2)) * kPiD * 9));
    }
}

TEST_CASE("the flux of a sky through the disc of the scene is the same with and without an aim") {
    const LightSet set({}, sky());
    double mean = 0;
    constexpr int kDirections = 400000;
    const Environment world = sky();
    for (int i = 0; i < kDirections; ++i)
        mean += world.luminance(warp_sphere({(float(i) + 0.5f) / kDirections, float(std::fmod(i * 0.6180339887498949, 1.0))}), 0).x;
    const double lit = 4 * kPiD * mean / kDirections * kPiD * 9;
    for (const bool aimed : {false, true}) {
        const SampleMoments m = flux(EmissionRays(set, reach(aimed)), 100000);
        CHECK(agrees(m, lit));
        CHECK_FALSE(agrees(m, 1.05 * lit));
    }
}

TEST_CASE("of several lights none is left out, and their powers add up") {
    const LightSet set = set_of({PointLight{{0, 1, 0}, {1000, 1000, 1000}},
                                 PointLight{{1, 1, 0}, {0.001f, 0.001f, 0.001f}},
                                 PointLight{{1, 1, 0}, {0, 0, 0}}});
    const EmissionRays rays(set, reach(false));
    int seen[3] = {};
    for (int i = 0; i < 1000; ++i) ++seen[rays.sample(float(i) / 1000, pair(2, i), pair(3, i), 0)->light];
    CHECK(seen[0] > 900);
    CHECK(seen[1] >= 40);
    CHECK(seen[2] == 0);
    CHECK(agrees(flux(rays), 4 * kPiD * 1000.001));
}

TEST_CASE("a dark world, and an even sky, send no rays") {
    CHECK(EmissionRays(set_of({}), reach(false)).empty());
    CHECK(EmissionRays(LightSet({}, Environment::constant({1, 1, 1})), reach(false)).empty());
    CHECK_FALSE(EmissionRays(set_of({}), reach(false)).sample(0.5f, {}, {}, 0).has_value());
}

TEST_CASE("directions from a point follow the density") {
    for (const Light& light : std::vector<Light>{
             PointLight{{0, 1, 0}, {1, 1, 1}},
             SpotLight{{0, 1, 0}, normalize(Vec3f{1, -1, 0}), {1, 1, 1}, 0.2f, 1.2f}}) {
        const LightSet set = set_of({light});
        const EmissionRays rays(set, reach(false));
        DirectionGrid grid;
        if (const auto* spot = std::get_if<SpotLight>(&light)) {
            grid.frame = Frame::from_normal(spot->direction);
            grid.cos_min = std::cos(1.2);
        }
        const double p = direction_p_value(
            grid,
            [&](Vec2f u) -> std::optional<Vec3f> { return rays.sample(0.5f, {}, u, 0)->direction; },
            [&](Vec3f w) { return rays.pdf(0, Vec3f{0, 1, 0} + w * 2.f, -w, 2, 0) * 4; });
        CHECK(p > 1e-4);
    }
}

TEST_CASE("aimed directions have the density that they claim: integrals of several functions") {
    const LightSet set = set_of({PointLight{{0, 1, 0}, {1, 1, 1}}});
    const EmissionRays rays(set, reach(true));
    // g and its mean over the sphere; the last g is 1 in the cone of a ball, with the sine 0.4 / distance.
    const double d2 = 1.5 * 1.5 + 1, cone = 1 - std::sqrt(1 - 0.16 / d2);
    const Vec3f to_ball = normalize(kBalls[0].center - Vec3f{0, 1, 0});
    const std::function<double(Vec3f)> g[] = {
        [](Vec3f) { return 1.0; }, [](Vec3f w) { return 1.0 + w.x; },
        [](Vec3f w) { return double(w.y) * w.y; },
        [&](Vec3f w) { return dot(w, to_ball) > 1 - cone ? 1.0 : 0.0; }};
    const double mean[] = {1, 1, 1 / 3.0, cone / 2};
    for (int k = 0; k < 4; ++k) {
        std::vector<double> values;
        for (int i = 0; i < 60000; ++i) {
            const auto ray = rays.sample(0.5f, {}, pair(3, i), 0);
            values.push_back(g[k](ray->direction) / ray->pdf / (4 * kPiD));
        }
        CHECK(agrees(moments(values), mean[k]));
        CHECK_FALSE(agrees(moments(values), mean[k] * 1.03));
    }
}

TEST_CASE("points and directions of lamps with an extent follow the density where they arrive") {
    // Rays are binned by the half of the lamp that they leave and by direction. The density of a sphere or a triangle
    // is uniform over its points only without aim, so the test checks E[f / pdf] over the rays = integral of f over
    // points and projected directions.
    for (const bool aimed : {false, true}) {
        const std::vector<Light> lamps{SphereLight{{{0, 1, 0}, 0.25f}, {1, 1, 1}}, triangle(false),
                                       triangle(true)};
        for (const Light& light : lamps) {
            const LightSet set = set_of({light});
            const EmissionRays rays(set, reach(aimed));
            double sum[2] = {}, squares[2] = {};
            constexpr int kRays = 40000;
            for (int i = 0; i < kRays; ++i) {
                const auto ray = rays.sample(0.5f, pair(2, i), pair(3, i), 0);
                if (!ray) continue;
                // pdf() at the point of arrival returns the density of the sample.
                const Vec3f at = ray->origin + ray->direction * 2.f;
                const float there = rays.pdf(0, at, -ray->direction, 2, 0);
                CHECK(there == doctest::Approx(ray->pdf).epsilon(2e-3));
                for (int k = 0; k < 2; ++k) {
                    const double f = k == 0 ? 1.0 : 1 + ray->direction.x + ray->origin.x;
                    sum[k] += f / ray->pdf, squares[k] += f * f / (double(ray->pdf) * ray->pdf);
                }
            }
            const double etendue = std::holds_alternative<SphereLight>(light)
                                       ? kPiD * 4 * kPiD * 0.0625
                                       : kPiD * area(triangle(false)) *
                                             (std::get<TriangleLight>(light).two_sided ? 2 : 1);
            const double error = std::sqrt(squares[0] / kRays) / std::sqrt(double(kRays));
            CHECK(std::abs(sum[0] / kRays - etendue) < 4 * error);
        }
    }
}

TEST_CASE("rays from infinity start before everything, and their density is found again on their way") {
    const LightSet set({DirectionalLight{normalize(Vec3f{1, -2, 0}), {1, 1, 1}},
                        DirectionalLight{normalize(Vec3f{1, -2, 0}), {1, 1, 1}, 0.8f}}, sky());
    for (const bool aimed : {false, true}) {
        const EmissionRays rays(set, reach(aimed));
        int skies = 0;
        Vec3f mean{};   // mean direction of the disc's rays
        int rays_of_disc = 0;
        for (int i = 0; i < 2000; ++i) {
            const auto ray = rays.sample(float(hash_uniform(1, i)), pair(2, i), pair(3, i), 0);
            REQUIRE(ray.has_value());
            CHECK(length(ray->origin - kAll.center) > kAll.radius);
            CHECK(dot(kAll.center - ray->origin, ray->direction) > 0);
            skies += ray->light == LightSet::kEnvironment;
            if (ray->light == 1) mean += ray->direction, ++rays_of_disc;
            const Vec3f at = ray->origin + ray->direction * 7.f;
            CHECK(rays.pdf(ray->light, at, -ray->direction, kInfinity, 0) ==
                  doctest::Approx(ray->pdf).epsilon(1e-3));
        }
        // Uniform over the disc: the mean cosine is the middle of its range.
        CHECK(dot(mean / float(rays_of_disc), normalize(Vec3f{1, -2, 0})) ==
              doctest::Approx((1 + std::cos(0.4)) / 2).epsilon(0.002));
        CHECK(skies > 100);
        CHECK(skies < 1900);
    }
}

TEST_CASE("what no ray leaves has no density: behind a lamp, outside a spot's cone, beside the scene") {
    const LightSet set = set_of({triangle(false),
                                 SpotLight{{0, 1, 0}, {0, -1, 0}, {1, 1, 1}, 0.2f, 0.5f},
                                 DirectionalLight{{0, -1, 0}, {1, 1, 1}},
                                 SphereLight{{{0, 1, 0}, 0.25f}, {1, 1, 1}}});
    const EmissionRays rays(set, reach(false));
    const Vec3f n = normalize(cross(triangle(false).b, triangle(false).c));
    CHECK(rays.pdf(0, n * 2.f, -n, 2, 0) > 0);
    CHECK(rays.pdf(0, n * -2.f, n, 2, 0) == 0);
    CHECK(rays.pdf(1, {0, 0, 0}, {0, 1, 0}, 1, 0) > 0);
    CHECK(rays.pdf(1, {0, 2, 0}, {0, -1, 0}, 1, 0) == 0);
    CHECK(rays.pdf(2, {0, 0, 0}, {0, 1, 0}, kInfinity, 0) > 0);
    CHECK(rays.pdf(2, {9, 0, 0}, {0, 1, 0}, kInfinity, 0) == 0);
    CHECK(rays.pdf(3, {0, 1, 0}, {0, 1, 0}, 0.25f, 0) == 0);   // from inside the ball
}
