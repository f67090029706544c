// light_keys_test.cpp -- animated lights: at each time they give the same light as static lights with the parameters of
// that time.
#include "light/light_keys.h"

#include <doctest/doctest.h>

#include "light/triangle_sampler.h"
#include "math/error.h"
#include "math/hash.h"

using namespace dg;

namespace {

Wavelengths white() {
    Wavelengths w;
    w.red = w.green = w.blue = Spectrum(1 / 3.f);
    w.d65 = Spectrum(1.f);
    return w;
}

float random(int purpose, int i) {
    return float(hash_uniform(purpose, i));
}
Vec3f random_point(int purpose, int i) {
    return {random(purpose, 3 * i) * 4 - 2, random(purpose, 3 * i + 1) * 4 - 2,
            random(purpose, 3 * i + 2) * 4 - 2};
}

/// Estimated irradiance on a ball at `position` (no cosine).
double fluence(const LightSet& lights, Vec3f position, float time, int n) {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const Vec2f u{random(5, i), random(6, i)};
        const auto s = lights.sample(float((i + 0.5) / n), u, position, time, white());
        if (s) sum += s->radiance[0] / s->pdf / n;
    }
    return sum;
}

/// A triangle that rotates about the x axis through `center`, `turns` times over the interval.
bool turn(TriangleLight& t, Vec3f center, float turns, float time) {
    const float angle = 2 * kPi * turns * time, c = std::cos(angle), s = std::sin(angle);
    for (Vec3f* p : {&t.a, &t.b, &t.c}) {
        const Vec3f d = *p - center;
        *p = center + Vec3f{d.x, c * d.y - s * d.z, s * d.y + c * d.z};
    }
    return true;
}

struct Changing {
    std::vector<Light> lights;
    LightMotion motion;

    void add(Keyed<Light> keys) {
        motion.keys[std::uint32_t(lights.size())] = keys;
        lights.push_back(keys.values[0]);
    }
    /// The lights at a time.
    LightSet still(float time) const {
        std::vector<Light> now = lights;
        for (const auto& [i, keys] : motion.keys) now[i] = keys.at(time);
        for (const auto& [i, bounds] : motion.triangles)
            motion.place(std::get<TriangleLight>(now[i]), time);
        return LightSet(now, std::nullopt);
    }
    LightSet set() const { return LightSet(lights, std::nullopt, LightChoice::tree, motion); }
};

/// Lights of every kind with animated pose and brightness.
Changing lamps() {
    Changing c;
    c.add({{0, 0.4f, 1},
           {PointLight{{-1, 0, 0}, {0, 0, 0}}, PointLight{{1, 1, 0}, {4, 4, 4}, 3},
            PointLight{{1, -1, 2}, {1, 1, 1}}}});
    c.add({{0, 1},
           {SpotLight{{0, 0, 3}, {1, 0, 0}, {9, 9, 9}, 0.2f, 0.4f},
            SpotLight{{0, 1, 3}, normalize(Vec3f{-1, 1, 0}), {2, 2, 2}, 0, 0.6f}}});
    c.add({{0, 0.5f, 0.5f, 1},  // off, then on with rising brightness
           {SphereLight{{{3, 3, 0}, 0.2f}, {20, 20, 20}}, SphereLight{{{3, 3, 0}, 0.2f}, {0, 0, 0}},
            SphereLight{{{-3, 3, 0}, 0.4f}, {0, 0, 0}}, SphereLight{{{0, 3, 3}, 0.1f}, {90, 90, 90}}}});
    c.add({{0, 1},
           {DirectionalLight{{0, -1, 0}, {0.2f, 0.2f, 0.2f}}, DirectionalLight{{1, 0, 0}, {0, 0, 0}}}});
    return c;
}

}  // namespace

TEST_CASE("moving, turning, dimming lights bring at each time what they bring standing still") {
    const Changing c = lamps();
    const LightSet set = c.set();
    for (int i = 0; i < 60; ++i) {
        const Vec3f p = random_point(1, i);
        const float time = random(2, i);
        const double expected = fluence(c.still(time), p, time, 4000);
        CHECK(fluence(set, p, time, 4000) == doctest::Approx(expected).epsilon(0.01));
    }
}

TEST_CASE("directions turn at constant speed, also by a half turn; ranges that end wait") {
    const Light down = DirectionalLight{{0, -1, 0}, {1, 1, 1}};
    const Light aside = DirectionalLight{{1, 0, 0}, {3, 3, 3}}, up = DirectionalLight{{0, 1, 0}, {1, 1, 1}};
    const auto third = std::get<DirectionalLight>(blend(down, aside, 1 / 3.f));
    CHECK(third.direction.x == doctest::Approx(0.5));
    CHECK(third.illuminance.x == doctest::Approx(5 / 3.0));
    const Light sun = DirectionalLight{{0, -1, 0}, {1, 1, 1}, 0.1f}, wide = DirectionalLight{{0, -1, 0}, {1, 1, 1}, 0.4f};
    CHECK(std::get<DirectionalLight>(blend(sun, wide, 1 / 3.f)).angle == doctest::Approx(0.2));
    const auto half = std::get<DirectionalLight>(blend(down, up, 0.5f));
    CHECK(length(half.direction) == doctest::Approx(1));
    CHECK(half.direction.y == doctest::Approx(0).epsilon(1e-6));
    const Light far = PointLight{}, near = PointLight{{}, {}, 2};
    CHECK(std::get<PointLight>(blend(far, near, 0.9f)).range > 1e30f);
    CHECK(std::get<PointLight>(blend(far, near, 1)).range == 2);
}

TEST_CASE("bounds hold wherever a light shines at any time") {
    const Changing c = lamps();
    int lit = 0;
    for (const auto& [light, keys] : c.motion.keys) {
        if (std::holds_alternative<DirectionalLight>(keys.values[0])) continue;
        const LightTree alone(std::vector{bounds_over(keys)});
        for (int i = 0; i < 20000; ++i) {
            const Vec3f p = random_point(1, i);
            const Light now = keys.at(random(2, i));
            const auto s = std::visit([&](const auto& l) { return sample_emitter(l, {0.5f, 0.5f}, p); }, now);
            if (!s || max_component(s->value) <= 0) continue;
            ++lit;
            REQUIRE(alone.importance(p) > 0);
        }
    }
    CHECK(lit > 20000);
}

TEST_CASE("a triangle that turns: sampled where it is, with the density it has there") {
    const Vec3f center{0, 2, 0};
    Changing c;
    c.lights.push_back(TriangleLight{{-1, 2, -1}, {1, 2, -1}, {0, 2, 1}, {5, 5, 5}, 3, 7, false});
    c.lights.push_back(PointLight{{2, -2, 1}, {1, 1, 1}});
    const auto place = [&](TriangleLight& t, float time) {
        return time < 0.8f && turn(t, center, 0.7f, time);  // hidden at the end
    };
    std::vector<TriangleLight> steps;
    for (int i = 0; i <= 32; ++i) {
        steps.push_back(std::get<TriangleLight>(c.lights[0]));
        turn(steps.back(), center, 0.7f, float(i) / 32);
    }
    c.motion.triangles[0] = bounds_over(steps, {5, 5, 5});
    c.motion.place = place;
    const LightSet set = c.set();
    int seen = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3f p = random_point(1, i) * 0.4f;
        const float time = random(2, i);
        const double lamp = 1 / length_squared(p - Vec3f{2, -2, 1});
        const double expected = time < 0.8f ? fluence(c.still(time), p, time, 4000) : lamp;
        CHECK(fluence(set, p, time, 4000) == doctest::Approx(expected).epsilon(0.02));
        for (int k = 0; k < 20; ++k) {
            const auto s = set.sample(random(8, k), {random(9, k), random(10, k)}, p, time, white());
            if (!s || s->light != 0) continue;
            ++seen;
            const TriangleLight now = *set.triangle_at(0, time);
            const float cosine = dot(normalize(TriangleSampler(now).normal()), s->wi);
            CHECK(s->pdf == doctest::Approx(set.pdf_triangle(3, 7, s->distance, cosine, p, time)).epsilon(1e-3));
        }
    }
    CHECK(seen > 100);
    CHECK(set.pdf_triangle(3, 7, 1, 1, {}, 0.9f) == 0);
}

TEST_CASE("steps of a turn that are far apart still bound the triangle between them") {
    const TriangleLight start{{-1, 2, -1}, {1, 2, -1}, {0, 2, 1}, {1, 1, 1}, 0, 0, false};
    for (const float turns : {0.02f, 0.3f, 1.f}) {
        std::vector<TriangleLight> steps(6, start);
        for (int i = 0; i < 6; ++i) turn(steps[i], {0, 0, 0}, turns, float(i) / 5);
        const LightBounds b = bounds_over(steps, {1, 1, 1});
        for (int i = 0; i < 3000; ++i) {
            TriangleLight now = start;
            turn(now, {0, 0, 0}, turns, float(i) / 3000);
            const LightBounds here = emitter_bounds(now);
            for (int k = 0; k < 3; ++k) {
                REQUIRE(here.min[k] >= b.min[k]);
                REQUIRE(here.max[k] <= b.max[k]);
            }
            REQUIRE(std::acos(std::clamp(dot(here.axis, b.axis), -1.f, 1.f)) <= b.spread + 1e-3f);
        }
    }
}

TEST_CASE("densities of a sphere that moves are those of its place at the time") {
    const Changing c = lamps();
    const LightSet set = c.set();
    for (int i = 0; i < 200; ++i) {
        const Vec3f p = random_point(1, i);
        const float time = random(2, i);
        const auto now = std::get<SphereLight>(c.motion.keys.at(2).at(time));
        const double ratio = set.pdf_sphere(0, p, time) / set.pdf_sphere(0, p, 0);
        const auto first = std::get<SphereLight>(c.lights[2]);
        CHECK(ratio == doctest::Approx(emitter_pdf(now, p) / emitter_pdf(first, p)).epsilon(1e-4));
        CHECK(set.sphere_radiance(0, {0, 0, 1}, time, white())[0] == doctest::Approx(now.luminance.x));
    }
}

TEST_CASE("a sky that turns and dims: its light moves with it, and so do samples and densities") {
    EnvironmentImage picture{64, 32, {}};
    for (int i = 0; i < 64 * 32; ++i)
        picture.pixels.push_back(Rgb{1, 1, 1} * float(std::pow(hash_uniform(1, i), 6)));
    const Environment still = Environment::image(picture, 1, {});
    const Environment sky = still.posed(
        {{0, 0.5f, 1}, {{{1, 1, 1}, 0}, {{3, 3, 3}, 2}, {{0, 0, 0}, 9}}});
    CHECK(sky.mean_luminance() == doctest::Approx(3 * still.mean_luminance()));
    const float time = 0.25f;  // rotated by 1 rad, twice as bright
    for (int i = 0; i < 500; ++i) {
        const Vec3f d = normalize(random_point(1, i));
        const Vec3f turned{std::cos(1.f) * d.x + std::sin(1.f) * d.z, d.y,
                           std::cos(1.f) * d.z - std::sin(1.f) * d.x};
        CHECK(sky.luminance(turned, time).x == doctest::Approx(2 * still.luminance(d, 0).x).epsilon(1e-3));
        CHECK(sky.pdf(turned, time) == doctest::Approx(still.pdf(d, 0)).epsilon(1e-3));
        const auto s = sky.sample({random(2, i), random(3, i)}, time);
        CHECK(s.pdf == doctest::Approx(sky.pdf(s.direction, time)).epsilon(3e-3));
    }
    const LightSet set({}, sky);
    const double all = 4 * kPiD * still.mean_luminance();
    CHECK(fluence(set, {}, time, 20000) == doctest::Approx(2 * all).epsilon(0.02));
    CHECK(fluence(set, {}, 1, 100) == 0);
}

TEST_CASE("keys that are no lights, and of another kind, are refused with their number") {
    Changing c;
    c.add({{0, 1}, {PointLight{}, PointLight{{}, {-1, 0, 0}}}});
    CHECK_THROWS_WITH_AS(c.set(), doctest::Contains("light 0 (point), key 1: intensity"), Error);
    Changing d;
    d.add({{0, 1}, {PointLight{}, DirectionalLight{{0, 1, 0}, {1, 1, 1}}}});
    CHECK_THROWS_WITH_AS(d.set(), doctest::Contains("key 1: kind"), Error);
    CHECK_THROWS_AS(Environment::constant({1, 1, 1}).posed({{0}, {{{-1, 0, 0}, 0}}}), Error);
}
