// emission_test.cpp -- points on emitters: their densities, and their total light against closed forms.
#include "light/emission.h"

#include <doctest/doctest.h>

#include <cmath>

#include "math/hash.h"
#include "math/warp.h"

using namespace dg;

namespace {

constexpr Viewpoint kEye{{0.2f, -0.1f, 0.3f}, 0.02f};

ViewCone everywhere() {
    return {.from = kEye};
}

EmissionSampler sampler_of(const LightSet& lights, const ViewCone& view = everywhere()) {
    return EmissionSampler(lights, std::span(&view, 1));
}

Vec2f random_2d(int i) {
    return {float(hash_uniform(1, i)), float(hash_uniform(2, i))};
}

TriangleLight triangle(Vec3f at, float size, Rgb luminance, std::uint32_t primitive) {
    TriangleLight t{at, at + Vec3f{size, 0, 0}, at + Vec3f{0, size, 0.3f * size}, luminance, 0, primitive,
                    true};
    t.even = true;
    return t;
}

Environment lamp_in_the_sky(int width, int height, int row, int column) {
    EnvironmentImage image{width, height, std::vector<Rgb>(std::size_t(width) * height, Rgb{1, 1, 1})};
    image.pixels[std::size_t(row) * width + column] = {1000, 1000, 1000};
    return Environment::image(std::move(image), 1, {});
}

}  // namespace

TEST_CASE("each emitter is chosen, and its density is that which is asked for afterwards") {
    std::vector<Light> all{SphereLight{{{0, 0, -3}, 0.01f}, {50, 50, 50}},
                           triangle({1, 0, -2}, 0.1f, {5, 5, 5}, 0),
                           triangle({-1, 1, -4}, 0.4f, {1, 2, 1}, 3),
                           PointLight{{0, 1, 0}, {9, 9, 9}},
                           SphereLight{{{2, 2, -3}, 0.2f}, {0, 0, 0}}};
    const LightSet lights(all, lamp_in_the_sky(32, 16, 8, 20));
    const EmissionSampler sampler = sampler_of(lights);
    std::array<int, 7> seen{};
    for (int i = 0; i < 4000; ++i) {
        const auto p = sampler.sample(float(hash_uniform(3, i)), random_2d(i), 0.5f, kEye);
        REQUIRE(p);
        ++seen[std::size_t(p->light + 1)];
        float again = 0;
        if (p->light == EmissionPoint::kSky)
            again = sampler.pdf_sky(p->position, 0.5f);
        else if (const auto* t = std::get_if<TriangleLight>(&lights.lights()[p->light]))
            again = sampler.pdf_triangle(t->instance, t->primitive, 0.5f);
        else
            again = sampler.pdf_sphere(0, p->position, 0.5f, kEye);
        REQUIRE(again == doctest::Approx(p->pdf).epsilon(2e-3));
    }
    for (const int light : {0, 1, 2, 3}) CHECK(seen[std::size_t(light)] > 10);   // sky, ball, triangles
    CHECK(seen[4] + seen[5] == 0);   // point lights are invisible, and the last ball is dark
}

TEST_CASE("points on emitters bring any point of the lens the light that the emitters give it") {
    const std::vector<Light> all{SphereLight{{{0, 0, -0.5f}, 0.1f}, {40, 40, 40}},
                                 triangle({0.3f, 0, -0.6f}, 0.05f, {20, 20, 20}, 0)};
    const LightSet lights(all, std::nullopt);
    const EmissionSampler sampler = sampler_of(lights);
    const Vec3f x = kEye.eye + Vec3f{0.01f, -0.012f, 0.005f};   // inside the lens
    double ball = 0, pane = 0;
    const int n = 200'000;
    for (int i = 0; i < n; ++i) {
        const auto p = sampler.sample(float(hash_uniform(3, i)), random_2d(i), 0, kEye);
        REQUIRE(p);
        const Vec3f to = x - p->position;
        const float cosine = dot(p->normal, normalize(to));
        const double share = std::abs(cosine) / (length_squared(to) * double(p->pdf)) / n;
        if (p->light == 0 && cosine > 0) ball += share;
        if (p->light == 1) pane += share;
    }
    // Solid angles of the ball's cap, and of the triangle by Van Oosterom and Strackee 1983.
    const double sine = 0.1 / length(Vec3f{0, 0, -0.5f} - x);
    CHECK(ball == doctest::Approx(2 * kPiD * (1 - std::sqrt(1 - sine * sine))).epsilon(0.006));
    const auto& t = std::get<TriangleLight>(all[1]);
    const Vec3d a = to_double(t.a - x), b = to_double(t.b - x), c = to_double(t.c - x);
    const double la = length(a), lb = length(b), lc = length(c);
    const double tangent = std::abs(dot(a, cross(b, c))) /
                           (la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la);
    CHECK(pane == doctest::Approx(2 * std::atan(tangent)).epsilon(0.02));
}

TEST_CASE("the side of a ball: a density that integrates to 1, and reaches all that the lens may see") {
    for (const float radius : {1e-3f, 0.05f, 0.4f}) {
        const Sphere shape{{0.2f, -0.1f, -0.2f}, radius};
        const LightSet lights({SphereLight{shape, {1, 1, 1}}}, std::nullopt);
        const EmissionSampler sampler = sampler_of(lights);
        double total = 0;
        const int n = 100'000;
        for (int i = 0; i < n; ++i) {
            const Vec3f normal = warp_sphere(random_2d(i));
            const Vec3f at = shape.center + normal * radius;
            const float pdf = sampler.pdf_sphere(0, at, 0, kEye);
            total += 4 * kPiD * radius * radius * pdf / n;
            const Vec3f rim = kEye.eye + normalize(Vec3f{normal.x, normal.y, 0}) * (0.999f * kEye.radius);
            if (dot(rim - at, normal) > 1e-4f) REQUIRE(pdf > 0);
        }
        CHECK(total == doctest::Approx(1).epsilon(0.02));
    }
    // From inside a ball, its outside is not visible.
    const LightSet dome({SphereLight{{kEye.eye, 1}, {1, 1, 1}}}, std::nullopt);
    CHECK_FALSE(sampler_of(dome).sample(0.5f, {0.5f, 0.5f}, 0, kEye));
}

TEST_CASE("what is certainly out of the frame's reach, or seen from behind, is left out") {
    const ViewCone view{.from = kEye, .axis = {0, 0, -1}, .half_angle = 0.3f};
    TriangleLight away = triangle({0.2f, -0.1f, -2}, 0.1f, {9, 9, 9}, 2);
    away.two_sided = false, away.mirrored = true;
    const LightSet lights({SphereLight{{{0.2f, 0, -3}, 0.01f}, {1, 1, 1}},
                           SphereLight{{{3, 0, -3}, 0.01f}, {1000, 1000, 1000}},
                           SphereLight{{{0.2f, 0, 3}, 0.01f}, {1000, 1000, 1000}}, away},
                          std::nullopt);
    const EmissionSampler sampler = sampler_of(lights, view);
    for (int i = 0; i < 100; ++i) {
        const auto p = sampler.sample(float(hash_uniform(3, i)), random_2d(i), 0, kEye);
        REQUIRE(p);
        REQUIRE(p->light == 0);
    }
    CHECK(sampler.pdf_sphere(1, {3, 0, -2.99f}, 0, kEye) == 0);
    CHECK(sampler.pdf_triangle(0, 2, 0) == 0);
    // A ball that intersects the edge of the cone counts as visible.
    const LightSet edge({SphereLight{{{1.15f, -0.1f, -2.7f}, 0.05f}, {1, 1, 1}}}, std::nullopt);
    CHECK_FALSE(sampler_of(edge, view).empty());
}

TEST_CASE("bright spots of a sky: only they, where they are seen, with a density that integrates to 1") {
    const Environment sky = lamp_in_the_sky(64, 32, 15, 40);
    const LightSet lights({}, sky);
    const EmissionSampler all = sampler_of(lights);
    double total = 0, covered = 0;
    const int n = 400'000;
    for (int i = 0; i < n; ++i) {
        const Vec3f d = warp_sphere(random_2d(i));
        const float pdf = all.pdf_sky(d, 0);
        total += 4 * kPiD * pdf / n;
        covered += (pdf > 0) / double(n);
        if (sky.luminance(d, 0).x > 30) REQUIRE(pdf > 0);
    }
    CHECK(total == doctest::Approx(1).epsilon(0.05));
    CHECK(covered < 0.005);
    for (int i = 0; i < 200; ++i) {
        const auto p = all.sample(0.5f, random_2d(i), 0, kEye);
        REQUIRE(p);
        REQUIRE(sky.luminance(p->position, 0).x > 1);
    }
    const Vec3f there = all.sample(0.5f, {0.5f, 0.5f}, 0, kEye)->position;
    CHECK(sampler_of(lights, {.from = kEye, .axis = -there, .half_angle = 1}).empty());
    CHECK_FALSE(sampler_of(lights, {.from = kEye, .axis = there, .half_angle = 0.1f}).empty());
    const LightSet even({}, Environment::constant({5, 5, 5}));
    CHECK(sampler_of(even).empty());
}

TEST_CASE("a light that moves is sampled where it is, and its density follows") {
    LightMotion motion;
    const SphereLight first{{{-1, 0, -3}, 0.1f}, {9, 9, 9}}, last{{{1, 0, -3}, 0.2f}, {9, 9, 9}};
    motion.keys[0] = Keyed<Light>{{0, 1}, {first, last}};
    const LightSet lights({first}, std::nullopt, LightChoice::tree, motion);
    const EmissionSampler sampler = sampler_of(lights);
    for (const float time : {0.f, 0.25f, 1.f}) {
        const auto p = sampler.sample(0.3f, {0.4f, 0.6f}, time, kEye);
        REQUIRE(p);
        const Vec3f center{2 * time - 1, 0, -3};
        CHECK(length(p->position - center) == doctest::Approx(0.1f + 0.1f * time));
        CHECK(sampler.pdf_sphere(0, p->position, time, kEye) == doctest::Approx(p->pdf).epsilon(1e-3));
    }
}
