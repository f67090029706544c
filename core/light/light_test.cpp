// light_test.cpp -- every kind of light against closed forms; samples against densities.
#include "light/light.h"

#include <doctest/doctest.h>

#include "light/direction_test.h"
#include "light/emitter.h"
#include "math/error.h"

using namespace dg;

namespace {

/// Wavelengths with the lanes red, green, blue and white, to test lights without the tables of spectrum/.
Wavelengths rgb_lanes() {
    Wavelengths w;
    w.red = {1, 0, 0, 1 / 3.f};
    w.green = {0, 1, 0, 1 / 3.f};
    w.blue = {0, 0, 1, 1 / 3.f};
    w.d65 = Spectrum(1.f);
    return w;
}

Vec2f uniform_2d(int i) {
    return {float(hash_uniform(5, 2 * i)), float(hash_uniform(5, 2 * i + 1))};
}

/// Estimated illuminance (white lane) on a facet.
double illuminance(const LightSet& lights, Vec3f position, Vec3f normal, int n = 40000) {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const auto s =
            lights.sample(float((i + 0.5) / n), uniform_2d(i), position, 0, rgb_lanes());
        if (s) sum += s->radiance[3] * std::max(0.f, dot(normal, s->wi)) / s->pdf;
    }
    return sum / n;
}

LightSet one(Light light) {
    return LightSet({std::move(light)}, std::nullopt);
}

TriangleLight triangle(Vec3f a, Vec3f b, Vec3f c, std::uint32_t primitive = 0,
                       bool two_sided = false) {
    return {a, b, c, {1, 1, 1}, 0, primitive, two_sided, false};
}

}  // namespace

TEST_CASE("point light: I / d^2 times the cosine, and the range window") {
    PointLight light{{0, 2, 0}, {8, 8, 8}};
    CHECK(illuminance(one(light), {0, 0, 0}, {0, 1, 0}, 10) == doctest::Approx(2));
    CHECK(illuminance(one(light), {2, 0, 0}, {0, 1, 0}, 10) ==
          doctest::Approx(std::sqrt(0.5)));
    light.range = 4;
    CHECK(illuminance(one(light), {0, 0, 0}, {0, 1, 0}, 10) ==
          doctest::Approx(2 * (1 - 1 / 16.0)));
    CHECK(illuminance(one(light), {0, -2.01f, 0}, {0, 1, 0}, 10) == 0);
    CHECK_FALSE(one(light).sample(0.5f, {}, {0, 2, 0}, 0, rgb_lanes()).has_value());
}

TEST_CASE("spot light: the angular attenuation of KHR_lights_punctual") {
    CHECK(spot_attenuation(1, 0.2f, 0.5f) == 1);
    CHECK(spot_attenuation(std::cos(0.2f), 0.2f, 0.5f) == doctest::Approx(1));
    CHECK(spot_attenuation(std::cos(0.5f), 0.2f, 0.5f) == doctest::Approx(0));
    CHECK(spot_attenuation(std::cos(0.6f), 0.2f, 0.5f) == 0);
    const double t = (std::cos(0.4) - std::cos(0.5)) / (std::cos(0.2) - std::cos(0.5));
    CHECK(spot_attenuation(std::cos(0.4f), 0.2f, 0.5f) ==
          doctest::Approx(t * t).epsilon(1e-5));

    const LightSet spot = one(SpotLight{{0, 3, 0}, {0, -1, 0}, {9, 9, 9}, 0.2f, 0.5f});
    CHECK(illuminance(spot, {0, 0, 0}, {0, 1, 0}, 10) == doctest::Approx(1));
    const Vec3f aside{3 * std::tan(0.4f), 0, 0};
    CHECK(illuminance(spot, aside, {0, 1, 0}, 10) ==
          doctest::Approx(t * t * std::pow(std::cos(0.4), 3)).epsilon(1e-4));
    CHECK(illuminance(spot, {3 * std::tan(0.51f), 0, 0}, {0, 1, 0}, 10) == 0);
    CHECK(illuminance(spot, {0, 6, 0}, {0, -1, 0}, 10) == 0);
}

TEST_CASE("directional light: its illuminance, anywhere") {
    const LightSet sun = one(DirectionalLight{{0, -1, 0}, {3, 3, 3}});
    CHECK(illuminance(sun, {1e4f, -7, 3}, {0, 1, 0}, 10) == doctest::Approx(3));
    CHECK(illuminance(sun, {0, 0, 0}, {0, 0.6f, 0.8f}, 10) == doctest::Approx(1.8));
    CHECK(sun.sample(0.5f, {}, {}, 0, rgb_lanes())->distance ==
          std::numeric_limits<float>::infinity());
}

namespace {

constexpr double degrees(double angle) { return angle * kPiD / 180; }

/// Illuminance by a uniform disc of half angle h on a facet at an angle to it, relative to a facing facet: the integral
/// of the cosine over the part of the disc above the facet.
double seen_share(double h, double tilt) {
    constexpr int kSteps = 400;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
        const double z = 1 - (i / kSteps + 0.5) / kSteps * (1 - std::cos(h));
        const double phi = (i % kSteps + 0.5) / kSteps * 2 * kPiD;
        sum += std::max(0.0, z * std::cos(tilt) + std::sqrt(1 - z * z) * std::cos(phi) * std::sin(tilt));
    }
    const double facing = kPiD * std::pow(std::sin(std::min(h, kPiD / 2)), 2);
    return sum / kSteps / kSteps * 2 * kPiD * (1 - std::cos(h)) / facing;
}

DirectionalLight sun_of(double angle, float lux = 3) {
    return {normalize(Vec3f{0.2f, -1, 0.4f}), Rgb{1, 1, 1} * lux, float(angle)};
}

}  // namespace

TEST_CASE("a sun with an angle: its illuminance on what faces it, and what of the disc a tilted facet sees") {
    for (const double angle : {0.001, 0.53, 20.0, 120.0, 180.0, 250.0, 360.0}) {
        CAPTURE(angle);
        const DirectionalLight sun = sun_of(degrees(angle));
        const Frame frame = Frame::from_normal(-sun.direction);
        for (const double tilt : {0.0, 30.0, 75.0, 95.0, 140.0}) {
            CAPTURE(tilt);
            const double t = degrees(tilt), wanted = 3 * seen_share(degrees(angle / 2), t);
            const Vec3f normal = frame.to_world({float(std::sin(t)), 0, float(std::cos(t))});
            CHECK(std::abs(illuminance(one(sun), {1, 2, 3}, normal, 400000) - wanted) < 0.03);
        }
    }
    CHECK(seen_share(degrees(10), degrees(60)) == doctest::Approx(0.5).epsilon(1e-4));   // fully visible: the cosine
    CHECK(seen_share(degrees(90), degrees(60)) == doctest::Approx(0.75).epsilon(1e-4));  // a hemisphere
    CHECK(seen_share(degrees(180), degrees(140)) == doctest::Approx(1).epsilon(1e-4));   // a full hemisphere
}

TEST_CASE("chi-square: directions of a sun with an angle fall evenly on its disc, and on no other") {
    for (const double angle : {8.0, 30.0, 180.0, 300.0, 360.0}) {
        CAPTURE(angle);
        const DirectionalLight sun = sun_of(degrees(angle));
        const double cos_half = std::cos(degrees(angle / 2));
        DirectionGrid grid{.frame = Frame::from_normal(-sun.direction), .cos_min = cos_half};
        const auto p_value = [&](double fault) {
            const auto sample = [&](Vec2f u) { return std::optional(sample_emitter(sun, u, {})->wi); };
            return direction_p_value(grid, sample, [&](Vec3f) { return fault / (2 * kPiD * (1 - cos_half)); });
        };
        CHECK(p_value(1) > 1e-3);
        CHECK(p_value(1.04) < 1e-6);
    }
    // The size of the sun, where cosines lose precision: sin^2 is uniformly distributed.
    const DirectionalLight sun = sun_of(degrees(0.53));
    double sum = 0, most = 0;
    for (int i = 0; i < 100000; ++i) {
        const double s2 = length_squared(cross(sample_emitter(sun, uniform_2d(i), {})->wi, sun.direction));
        sum += s2, most = std::max(most, s2);
    }
    const double edge = std::pow(std::sin(degrees(0.265)), 2);
    CHECK(sum / 100000 == doctest::Approx(edge / 2).epsilon(0.005).scale(0));
    CHECK(most == doctest::Approx(edge).epsilon(1e-3).scale(0));
}

TEST_CASE("a sun without an angle, and one of nearly none, are parallel light") {
    const DirectionalLight parallel = sun_of(0), thin = sun_of(1e-12);
    for (int i = 0; i < 100; ++i) {
        const auto exact = sample_emitter(parallel, uniform_2d(i), {}), near = sample_emitter(thin, uniform_2d(i), {});
        CHECK(exact->wi == -parallel.direction);
        CHECK(exact->value == parallel.illuminance);
        CHECK(length(near->wi - exact->wi) < 1e-6f);
        CHECK(near->value == parallel.illuminance);
    }
}

TEST_CASE("sphere light: E = pi L (r/d)^2 on a facet that faces it, far, near and tiny") {
    for (float r : {1e-3f, 0.5f, 1.9f, 1.999f}) {
        const LightSet lights = one(SphereLight{{{0, 2, 0}, r}, {5, 5, 5}});
        CHECK(illuminance(lights, {0, 0, 0}, {0, 1, 0}) / (kPiD * 5 * r * r / 4) ==
              doctest::Approx(1).epsilon(0.005));
    }
    // From inside, half of all directions count.
    const LightSet around = one(SphereLight{{{0, 0, 0}, 2}, {5, 5, 5}});
    CHECK(illuminance(around, {0.3f, 1, 0}, {0, 1, 0}) ==
          doctest::Approx(kPiD * 5).epsilon(0.01));
}

TEST_CASE("triangle light: form factor of a parallel rectangle above a corner facet") {
    // Source: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3.
    const float a = 1.5f, b = 0.7f, c = 1.1f;
    const double A = a / c, B = b / c;
    const double factor =
        (A / std::sqrt(1 + A * A) * std::atan(B / std::sqrt(1 + A * A)) +
         B / std::sqrt(1 + B * B) * std::atan(A / std::sqrt(1 + B * B))) /
        (2 * kPiD);
    const Vec3f p{0, c, 0}, q{a, c, 0}, r{a, c, b}, s{0, c, b};
    for (bool two_sided : {false, true}) {
        const LightSet lights(
            {triangle(p, q, r, 0, two_sided), triangle(p, r, s, 1, two_sided)},
            std::nullopt);
        CHECK(illuminance(lights, {0, 0, 0}, {0, 1, 0}) ==
              doctest::Approx(kPiD * factor).epsilon(0.01));
        const double above = illuminance(lights, {0, 2 * c, 0}, {0, -1, 0});
        CHECK(above == doctest::Approx(two_sided ? kPiD * factor : 0).epsilon(0.01));
    }
}

TEST_CASE("chi-square: directions toward spheres and triangles follow their density") {
    const Vec3f position{0.2f, -0.3f, 0.1f};
    struct Case {
        Sphere sphere;
        bool whole;
    };
    for (const Case& c : {Case{{{1, 2, 3}, 0.5f}, false}, Case{{{1, 2, 3}, 3.5f}, false},
                          Case{{{0.3f, 0, 0}, 2}, true}}) {
        const SphereLight light{c.sphere, {1, 1, 1}};
        DirectionGrid grid;
        const Vec3f to = light.shape.center - position;
        if (!c.whole) {  // the grid covers exactly the cone
            grid.frame = Frame::from_normal(normalize(to));
            grid.cos_min = std::sqrt(1 - double(light.shape.radius) * light.shape.radius /
                                             length_squared(to));
        }
        auto sample = [&](Vec2f u) {
            return std::optional(sample_emitter(light, u, position)->wi);
        };
        auto p_value = [&](double fault, int n) {
            return direction_p_value(
                grid, sample, [&](Vec3f) { return fault * emitter_pdf(light, position); },
                n);
        };
        CHECK(p_value(1, 200000) > 1e-3);
        CHECK(p_value(1.02, 1000000) < 1e-6);
    }

    const TriangleLight t = triangle({-1, 1.5f, -1}, {2, 1, 0.5f}, {-0.5f, 2, 1.5f});
    const Vec3f e1 = t.b - t.a, e2 = t.c - t.a, n = normalize(cross(e1, e2));
    auto pdf = [&](Vec3f w) -> double {  // Moeller and Trumbore 1997
        const Vec3f pv = cross(w, e2), tv = position - t.a, qv = cross(tv, e1);
        const float det = dot(e1, pv), u = dot(tv, pv) / det, v = dot(w, qv) / det,
                    d = dot(e2, qv) / det;
        const bool hit = u >= 0 && v >= 0 && u + v <= 1 && d > 0;
        return hit ? emitter_pdf(t, d, dot(n, w)) : 0;
    };
    TriangleLight facing = t;
    if (dot(n, t.a - position) > 0) std::swap(facing.b, facing.c);
    DirectionGrid grid;
    grid.frame = Frame::from_normal(normalize(t.a + t.b + t.c - position * 3));
    grid.cos_min = 0;
    auto sample = [&](Vec2f u) {
        return std::optional(sample_emitter(facing, u, position)->wi);
    };
    CHECK(direction_p_value(grid, sample, pdf, 200000, 64) > 1e-3);
    CHECK(direction_p_value(
              grid, sample, [&](Vec3f w) { return 1.02 * pdf(w); }, 1000000, 64) < 1e-6);
}

TEST_CASE("sample().pdf is what the pdf functions say of the same direction") {
    std::vector<Light> lights{SphereLight{{{1, 2, 3}, 0.5f}, {1, 2, 3}},
                              PointLight{{0, 3, 0}, {1, 1, 1}},
                              triangle({0, 2, 0}, {1, 2, 0}, {1, 2, 1}, 4),
                              DirectionalLight{{0, -1, 0}, {1, 1, 1}},
                              SphereLight{{{-3, 1, 0}, 0.1f}, {9, 9, 9}},
                              triangle({5, 0, 0}, {5, 1, 0}, {5, 0, 1}, 9, true)};
    std::get<TriangleLight>(lights[5]).instance = 2;
    EnvironmentImage sky{8, 4, {}};
    for (int i = 0; i < 32; ++i)
        sky.pixels.push_back(Rgb{1, 1, 1} * float(0.1 + hash_uniform(1, i)));
    const LightSet set(lights, Environment::image(sky, 1, {}));
    int kinds[4] = {};
    for (int i = 0; i < 4000; ++i) {
        const Vec3f p{float(hash_uniform(2, i)) * 4 - 2, float(hash_uniform(3, i)),
                      float(hash_uniform(4, i))};
        const auto s =
            set.sample(float(hash_uniform(6, i)), uniform_2d(i), p, 0, rgb_lanes());
        if (!s) continue;
        float pdf = s->pdf;
        if (s->light >= 0 &&
            std::holds_alternative<TriangleLight>(set.lights()[s->light])) {
            ++kinds[0];
            const auto& t = std::get<TriangleLight>(set.lights()[s->light]);
            const float cosine = dot(normalize(cross(t.b - t.a, t.c - t.a)), s->wi);
            pdf = set.pdf_triangle(t.instance, t.primitive, s->distance, std::abs(cosine),
                                   p, 0);
            const Vec3f on =
                t.a + (t.b - t.a) * s->barycentric.x + (t.c - t.a) * s->barycentric.y;
            CHECK(length(on - p - s->wi * s->distance) < 1e-4f);
        } else if (!s->delta && s->distance < 100) {
            ++kinds[1];
            const bool second = s->radiance[0] == 9;
            pdf = set.pdf_sphere(second, p, 0);
            CHECK(set.sphere_radiance(second, -s->wi, 0, rgb_lanes())[0] == s->radiance[0]);
        } else if (!s->delta) {
            ++kinds[2];
            pdf = set.pdf_environment(s->wi, p, 0);
        } else {
            ++kinds[3];
        }
        CHECK(s->pdf == doctest::Approx(pdf).epsilon(1e-3));
        CHECK(s->pdf == doctest::Approx(set.pdf(s->light, p, s->wi, s->distance, 0)).epsilon(1e-3));
    }
    for (int k : kinds) CHECK(k > 100);
    CHECK(set.pdf_triangle(0, 3, 1, 1, {}, 0) == 0);
    CHECK(set.pdf_triangle(0, 5, 1, 1, {}, 0) == 0);
    CHECK(set.pdf_triangle(1, 0, 1, 1, {}, 0) == 0);
    CHECK(set.pdf_triangle(7, 0, 1, 1, {}, 0) == 0);
}

namespace {

/// Estimate as the mean of several joint samples.
double illuminance_by_several(const LightSet& lights, Vec3f position, Vec3f normal, int n) {
    double sum = 0;
    std::array<LightSample, LightSet::kMostSamples> found;
    for (int i = 0; i < n; ++i) {
        lights.sample_several(float((i + 0.5) / n), uniform_2d(i), position, 0, rgb_lanes(), found);
        for (const LightSample& s : found)
            if (s.pdf > 0) sum += s.radiance[3] * std::max(0.f, dot(normal, s.wi)) / s.pdf;
    }
    return sum / (double(n) * found.size());
}

}  // namespace

TEST_CASE("the sum of many lights and a sky is the sum of each") {
    std::vector<Light> lights;
    double expected = kPiD * 0.2;
    for (int i = 0; i < 300; ++i) {
        const Vec3f p{float(hash_uniform(1, i)) * 20 - 10,
                      0.5f + 3 * float(hash_uniform(2, i)),
                      float(hash_uniform(3, i)) * 20 - 10};
        lights.push_back(PointLight{p, {1, 1, 1}});
        expected += p.y / std::pow(length_squared(p), 1.5);
    }
    lights.push_back(DirectionalLight{{0, -1, 0}, {0.1f, 0.1f, 0.1f}});
    lights.push_back(PointLight{{0, 1, 0}, {0, 0, 0}});  // dark lights are never chosen
    expected += 0.1;
    const EnvironmentImage even{4, 2, std::vector<Rgb>(8, Rgb{0.2f, 0.2f, 0.2f})};
    const LightSet set(lights, Environment::image(even, 1, {}));
    CHECK(illuminance(set, {0, 0, 0}, {0, 1, 0}, 400000) ==
          doctest::Approx(expected).epsilon(0.01));
    CHECK(illuminance_by_several(set, {0, 0, 0}, {0, 1, 0}, 100000) == doctest::Approx(expected).epsilon(0.01));
}

TEST_CASE("a sample of a sky's picture has an estimate, without colour; the picture is read later") {
    const EnvironmentImage sky{2, 1, {{4, 1, 0}, {0, 1, 2}}};
    const LightSet set({}, Environment::image(sky, 1, {}));
    for (int i = 0; i < 100; ++i) {
        const auto s = set.sample(0.5f, uniform_2d(i), {}, 0, rgb_lanes());
        REQUIRE(s);
        CHECK(s->uneven);
        CHECK(s->light == LightSet::kEnvironment);
        CHECK(s->radiance.min() > 0);
        CHECK(s->radiance[0] == s->radiance[2]);
        const auto seen = set.lookup_environment(s->wi, {}, 0, rgb_lanes());
        CHECK(seen.radiance[0] == set.environment_radiance(s->wi, 0, rgb_lanes())[0]);
        CHECK(seen.pdf == set.pdf_environment(s->wi, {}, 0));
        CHECK(seen.pdf == doctest::Approx(s->pdf).epsilon(1e-3));
    }
}

TEST_CASE("an even sky is left to the BSDF") {
    const LightSet sky({}, Environment::constant({1, 1, 1}));
    CHECK(sky.empty());
    CHECK(sky.pdf_environment({0, 1, 0}, {0, 0, 0}, 0) == 0);
    CHECK(sky.environment_radiance({0, 1, 0}, 0, rgb_lanes())[0] == doctest::Approx(1));
}

TEST_CASE("illuminance: I / d^2 of a lamp, with what comes from infinity; nothing without lights") {
    CHECK(LightSet().illuminance({}) == 0);
    const DirectionalLight sun{{0, 0, -1}, {3, 3, 3}};
    const LightSet one({PointLight{{0, 0, 2}, {8, 8, 8}}}, {}), both({PointLight{{0, 0, 2}, {8, 8, 8}}, sun}, {});
    CHECK(one.illuminance({}) == doctest::Approx(2));
    CHECK(one.illuminance({0, 0, -2}) == doctest::Approx(0.5));
    CHECK(both.illuminance({}) == doctest::Approx(5));
}

TEST_CASE("no light, bad light") {
    CHECK(LightSet().empty());
    CHECK_FALSE(LightSet().sample(0.5f, {}, {}, 0, rgb_lanes()).has_value());
    CHECK(LightSet({PointLight{{}, {0, 0, 0}}}, std::nullopt).empty());
    CHECK(LightSet().environment_radiance({0, 1, 0}, 0, rgb_lanes())[0] == 0);
    CHECK_THROWS_WITH_AS(
        one(PointLight{{}, {-1, 0, 0}}),
        doctest::Contains("light 0 (point): intensity: wanted finite values >= 0"),
        Error);
    CHECK_THROWS_AS(one(SpotLight{{}, {0, -1, 0}, {1, 1, 1}, 0.5f, 0.4f}), Error);
    CHECK_THROWS_AS(one(DirectionalLight{{0, -2, 0}, {1, 1, 1}}), Error);
    for (const float angle : {-0.1f, 6.4f, std::numeric_limits<float>::quiet_NaN()})
        CHECK_THROWS_WITH_AS(one(DirectionalLight{{0, -1, 0}, {1, 1, 1}, angle}),
                             doctest::Contains("light 0 (directional): angle: wanted 0 to 2 pi rad"), Error);
    CHECK_THROWS_AS(one(SphereLight{{{}, 0}, {1, 1, 1}}), Error);
}
