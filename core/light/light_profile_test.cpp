// light_profile_test.cpp -- profiles against the formulas of their factors, and lamps with profiles.
#include "light/light_profile.h"

#include <doctest/doctest.h>

#include "light/emission_ray.h"
#include "light/emitter_points.h"
#include "light/light.h"
#include "math/error.h"
#include "math/hash.h"
#include "math/warp.h"

using namespace dg;

namespace {

constexpr float kDegree = kPi / 180;

Vec3f direction(double theta, double phi) {   // in the lamp's frame
    return to_float(Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)});
}

Vec2f random_2d(int seed, int i) {
    return {float(hash_uniform(seed, 2 * i)), float(hash_uniform(seed, 2 * i + 1))};
}

/// A table that depends on both angles, has an off-axis peak, and is 0 beyond 100 degrees.
ProfileTable skew() {
    ProfileTable t{{0, 20 * kDegree, 60 * kDegree, 100 * kDegree}, {0, kPi / 2, kPi, 2 * kPi}, {}};
    t.values = {5, 5, 5, 5, 9, 7, 2, 9, 4, 1, 3, 4, 0, 0, 0, 0};
    return t;
}

LightProfile profile_of(ProfileParts parts) { return LightProfile(std::move(parts)); }
std::shared_ptr<const LightProfile> shared_profile(ProfileParts parts) {
    return std::make_shared<const LightProfile>(std::move(parts));
}

/// Mean over the sphere, and cosine-weighted mean for a surface that faces -z, by random directions.
struct Means {
    double all = 0, facing = 0;
};
Means measured(const LightProfile& p, int n = 400000) {
    Means m;
    for (int i = 0; i < n; ++i) {
        const Vec3f w = warp_sphere(random_2d(3, i));
        const double v = p.at(w).x;
        m.all += v / n, m.facing += v * std::max(0.f, -w.z) * 4 / n;
    }
    return m;
}

Wavelengths white() {
    Wavelengths w;
    w.red = w.green = w.blue = Spectrum(1 / 3.f);
    w.d65 = Spectrum(1.f);
    return w;
}

LightSet one(Light light, std::shared_ptr<const LightProfile> profile, LightMotion motion = {}) {
    return LightSet({std::move(light)}, std::nullopt, LightChoice::tree, std::move(motion), {{std::move(profile)}, {}});
}

/// A rotation about an oblique axis.
Affine3d turned(double angle) {
    return to_matrix(Quaterniond::from_axis_angle(normalize(Vec3d{1, 2, -0.5}), angle));
}

}  // namespace

TEST_CASE("cone: one within, nothing beyond, and the smooth step of UsdLux between") {
    const ProfileCone hard{0.5f, 0}, soft{0.5f, 0.4f};
    CHECK(hard.at(0) == 1);
    CHECK(hard.at(0.5f) == 1);
    CHECK(hard.at(std::nextafter(0.5f, 1.f)) == 0);
    CHECK(soft.at(0.3f) == 1);
    CHECK(soft.at(0.4f) == doctest::Approx(0.5));
    CHECK(soft.at(0.35f) == doctest::Approx(1 - (3 * 0.0625 - 2 * 0.015625)));
    CHECK(soft.at(0.5f) == doctest::Approx(0));
    CHECK(soft.at(0.51f) == 0);
    const LightProfile p = profile_of({.cones = {hard}});
    CHECK(p.at(direction(0.4999, 1)).x == 1);
    CHECK(p.at(direction(0.5001, 1)).x == 0);
    CHECK(p.spread() == 0.5f);
}

TEST_CASE("focus: a power of the cosine on both sides, and the tint in its place") {
    const LightProfile p = profile_of({.focuses = {{3, {0.5f, 0, 1}}}});
    const Rgb f = p.at(direction(1.1, 2));
    const double c3 = std::pow(std::cos(1.1), 3);
    CHECK(f.x == doctest::Approx(0.5 * (1 - c3) + c3));
    CHECK(f.y == doctest::Approx(c3));
    CHECK(f.z == doctest::Approx(1));
    CHECK(p.at(direction(kPiD - 1.1, 2)).y == doctest::Approx(c3));
    CHECK(p.spread() == kPi);
}

TEST_CASE("table: bilinear in theta and phi, phi from +x toward +y, and dark beyond its angles") {
    const LightProfile p = profile_of({.scale = 2, .tables = {skew()}});
    CHECK(p.at({0, 0, -1}).x == doctest::Approx(10));
    CHECK(p.at(direction(20 * kDegree, 0)).x == doctest::Approx(18));
    CHECK(p.at(Vec3f{0, std::sin(20 * kDegree), -std::cos(20 * kDegree)}).x == doctest::Approx(14));   // +y: 90 degrees
    CHECK(p.at(Vec3f{-std::sin(20 * kDegree), 0, -std::cos(20 * kDegree)}).x == doctest::Approx(4));
    CHECK(p.at(direction(40 * kDegree, kPiD / 4)).x == doctest::Approx(2 * (9 + 7 + 4 + 1) / 4.0).epsilon(1e-4));
    CHECK(p.at(direction(40 * kDegree, 1.5 * kPiD)).x == doctest::Approx(2 * (2 + 9 + 3 + 4) / 4.0).epsilon(1e-4));
    CHECK(p.at(direction(101 * kDegree, 1)).x == 0);
    CHECK(p.at({0, 0, 1}).x == 0);
    CHECK(p.peak() == doctest::Approx(18));
    CHECK(p.spread() == doctest::Approx(100 * kDegree));
}

TEST_CASE("means of cones and powers have closed forms; those of products are what random directions find") {
    for (const float angle : {0.02f, 0.7f, 2.2f}) {
        const LightProfile p = profile_of({.cones = {{angle, 0}}});
        CHECK(p.mean().x == doctest::Approx((1 - std::cos(double(angle))) / 2).epsilon(1e-5));
        const double s = std::sin(std::min<double>(angle, kPiD / 2));
        CHECK(p.facing_mean().x == doctest::Approx(s * s).epsilon(1e-5));
    }
    for (const float n : {0.f, 1.f, 7.f, 3000.f}) {
        const LightProfile p = profile_of({.focuses = {{n, {}}}});
        CHECK(p.mean().x == doctest::Approx(1 / (n + 1.0)).epsilon(1e-4));
        CHECK(p.facing_mean().x == doctest::Approx(2 / (n + 2.0)).epsilon(1e-4));
    }
    for (const LightProfile& p : {profile_of({.tables = {skew()}}),
                                  profile_of({.cones = {{1.2f, 0.7f}}, .focuses = {{2, {}}}, .tables = {skew()}})}) {
        const Means m = measured(p);
        CHECK(p.mean().x == doctest::Approx(m.all).epsilon(0.01));
        CHECK(p.facing_mean().x == doctest::Approx(m.facing).epsilon(0.01));
    }
}

TEST_CASE("tables as fine as a file may have them are measured in a second, and no peak is missed") {
    const auto fine = [](std::size_t rows, std::size_t columns) {
        ProfileTable t{{}, {}, std::vector<float>(rows * columns, 1.f)};
        for (std::size_t i = 0; i < rows; ++i) t.theta.push_back(kPi * float(double(i) / double(rows - 1)));
        for (std::size_t i = 0; i < columns; ++i) t.phi.push_back(2 * kPi * float(double(i) / double(columns - 1)));
        t.values[columns * (rows / 3) + columns / 5] = 9;
        return t;
    };
    for (const auto [rows, columns] : {std::pair{2, 500000}, {200000, 5}, {1000, 1000}}) {
        const LightProfile p = profile_of({.focuses = {{2000, {0.5f, 0.5f, 0.5f}}}, .tables = {fine(rows, columns)}});
        CHECK(p.mean().x == doctest::Approx(0.5 * (1 + 1 / 2001.0)).epsilon(1e-2));
        CHECK(p.peak() >= 4.5f);
    }
}

TEST_CASE("what is no profile is an error that names the part") {
    const auto bad = [](ProfileParts parts) { CHECK_THROWS_AS(LightProfile(std::move(parts)), Error); };
    bad({.scale = -1});
    bad({.cones = {{0, 0}}});
    bad({.cones = {{4, 0}}});
    bad({.cones = {{1, 1.5f}}});
    bad({.focuses = {{-1, {}}}});
    bad({.focuses = {{1, {-1, 0, 0}}}});
    ProfileTable t = skew();
    t.theta[1] = t.theta[2], bad({.tables = {t}});
    t = skew(), t.phi.back() = 6, bad({.tables = {t}});
    t = skew(), t.values.pop_back(), bad({.tables = {t}});
    t = skew(), t.values[3] = NAN, bad({.tables = {t}});
    t = skew(), t.values[3] = -1, bad({.tables = {t}});
    t = skew(), t.values[3] = 1e30f, bad({.scale = 1e30f, .tables = {t}});
    CHECK_THROWS_AS(one(PointLight{{}, {1, 1, 1}, 9, LampShape(1, {})}, shared_profile({})), Error);
}

TEST_CASE("axes: neither scale nor shear of a lamp changes them, a mirror turns y around") {
    Affine3d m = turned(1.1);
    const LampAxes plain(m);
    m.x = m.x * 3.0 + m.z * 0.7, m.y = m.y * 0.2, m.z = m.z * 11.0;
    const LampAxes scaled(m);
    for (int k = 0; k < 3; ++k) {
        CHECK(scaled.x[k] == doctest::Approx(plain.x[k]));
        CHECK(scaled.y[k] == doctest::Approx(plain.y[k]));
        CHECK(scaled.z[k] == doctest::Approx(plain.z[k]));
    }
    m.y = -m.y;
    const LampAxes mirrored(m);
    const LampShape shape(0, m);
    for (int k = 0; k < 3; ++k) {
        CHECK(mirrored.y[k] == doctest::Approx(-plain.y[k]));
        CHECK(mirrored.x[k] == doctest::Approx(plain.x[k]));
        const Vec3f w = normalize(Vec3f{1, -2, 0.3f});
        CHECK(shape.local(w)[k] == doctest::Approx(mirrored.local(w)[k]).epsilon(1e-5));
    }
}

TEST_CASE("point light: its intensity times the table, in its own frame, seen from anywhere") {
    const auto profile = shared_profile({.tables = {skew()}});
    const Affine3d frame = turned(0.9);
    const LightSet set = one(PointLight{{1, 2, 3}, {2, 2, 2}, 1e9f, LampShape(0, frame)}, profile);
    int lit = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3f local = warp_sphere(random_2d(9, i));
        const Vec3f away = to_float(frame.vector(to_double(local)));
        const auto s = set.sample(0.5f, {}, Vec3f{1, 2, 3} + away * 4.f, 0, white());
        const float expected = profile->at(local).x * 2 / 16;
        CHECK(bool(s) == (expected > 0));
        if (!s) continue;
        ++lit;
        CHECK(s->radiance[0] / s->pdf == doctest::Approx(expected).epsilon(1e-3));
    }
    CHECK(lit > 100);
}

TEST_CASE("ball: from afar the intensity of its table, and rays that meet it find the same light") {
    const auto profile = shared_profile({.tables = {skew()}});
    const Affine3d frame = turned(2.1);
    const float r = 0.01f;
    const LightSet set = one(SphereLight{{{0, 0, 0}, r}, {3, 3, 3}, LampShape(0, frame)}, profile);
    for (int i = 0; i < 100; ++i) {
        const Vec3f local = warp_sphere(random_2d(21, i));
        const Vec3f away = to_float(frame.vector(to_double(local)));
        const auto s = set.sample(0.5f, {0.3f, 0.6f}, away * 5.f, 0, white());
        const float factor = profile->at(local).x;
        if (!s) {
            CHECK(factor < 0.1f);
            continue;
        }
        CHECK(s->radiance[0] / s->pdf == doctest::Approx(3 * factor * kPi * r * r / 25).epsilon(0.02));
        CHECK(set.sphere_radiance(0, -s->wi, 0, white())[0] == doctest::Approx(s->radiance[0]));
    }
}

TEST_CASE("rays that leave a lamp carry its whole power, and their density is what is claimed") {
    const auto skewed = shared_profile({.tables = {skew()}});
    const auto narrow = shared_profile({.cones = {{0.1f, 0.5f}}, .tables = {skew()}});
    const EmissionReach reach{{{0, 0, 0}, 5}, {{0, 0, 0}, 5}};
    for (const auto& profile : {skewed, narrow})
        for (const bool ball : {false, true}) {
            const LampShape lamp(0, turned(0.4));
            const float r = 0.2f;
            const Light light = ball ? Light(SphereLight{{{1, 0, 0}, r}, {3, 3, 3}, lamp})
                                     : Light(PointLight{{1, 0, 0}, {3, 3, 3}, 1e9f, lamp});
            const LightSet set = one(light, profile);
            const EmissionRays rays(set, reach);
            double sum = 0;
            const int n = 200000;
            for (int i = 0; i < n; ++i) {
                const auto ray = rays.sample(0.5f, random_2d(31, i), random_2d(33, i), 0);
                if (ray) sum += ray->value.x / ray->pdf / n;
            }
            const double area = ball ? kPiD * r * r : 1;
            const double power = 4 * kPiD * 3 * area * profile->mean().x;
            CHECK(sum == doctest::Approx(power).epsilon(ball && profile == narrow ? 0.05 : 0.01));
            CHECK(rays.power() == doctest::Approx(power).epsilon(0.05));
            const auto ray = rays.sample(0.5f, {0.2f, 0.7f}, {0.4f, 0.1f}, 0);
            REQUIRE(ray);
            const float d = 3;
            const float claimed = rays.pdf(0, ray->origin + ray->direction * d, -ray->direction, d, 0);
            CHECK(claimed * (ball ? 1 : d * d) == doctest::Approx(ray->pdf).epsilon(1e-3));
        }
}

TEST_CASE("flare and scatter aim at a lamp by the same light") {
    const auto profile = shared_profile({.tables = {skew()}});
    const LightSet set = one(PointLight{{0, 0, 0}, {2, 2, 2}, 1e9f, LampShape(0, turned(0.9))}, profile);
    const Vec3f to{1, -2, 2};   // 3 m away
    const ViewCone view{.from = {to, 0.01f}};
    const EmitterPoints points(set, std::span(&view, 1));
    REQUIRE(points.count() == 1);
    const auto from = points.sample(0, 0.5f, {0.5f, 0.5f}, 0, view.from);
    REQUIRE(from);
    const Vec3f local = LampAxes(turned(0.9)).local(to * (1 / 3.f));
    CHECK(points.delta_value(*from, to, 0).x == doctest::Approx(2 * profile->at(local).x).epsilon(1e-4));
}

TEST_CASE("a lamp that turns shines by its frame of the time, and the tree knows that it turns") {
    const auto profile = shared_profile({.cones = {{0.3f, 0}}});
    const auto about_y = [](double angle) {
        return to_matrix(Quaterniond::from_axis_angle({0, 1, 0}, angle));
    };
    LightMotion motion;
    const auto key = [&](double angle) { return Light(PointLight{{}, {1, 1, 1}, 1e9f, LampShape(0, about_y(angle))}); };
    motion.keys[0] = {{0, 1}, {key(0), key(1.2)}};
    const LightSet set = one(key(0), profile, motion);
    for (const double t : {0.0, 0.25, 0.5, 1.0}) {
        const Vec3f axis = to_float(about_y(1.2 * t).vector({0, 0, -1}));
        const Vec3f aside = to_float(about_y(1.2 * t + 0.31).vector({0, 0, -1}));
        CHECK(set.sample(0.5f, {}, axis * 2.f, float(t), white()).has_value());
        CHECK_FALSE(set.sample(0.5f, {}, aside * 2.f, float(t), white()).has_value());
    }
    CHECK(set.bounds_of(0).spread == kPi);
    motion.keys[0].values[1] = Light(PointLight{{}, {1, 1, 1}, 1e9f, {}});
    CHECK_THROWS_AS(one(key(0), profile, motion), Error);
}

TEST_CASE("among many shaped lamps every place that one lights has a chance, as the estimate of all of them shows") {
    std::vector<Light> lights;
    std::vector<LampShape> lamps;
    const auto cone = shared_profile({.cones = {{0.5f, 0.3f}}});
    const auto skewed = shared_profile({.tables = {skew()}});
    for (int i = 0; i < 40; ++i) {
        const LampShape lamp(i % 2, turned(i * 0.7));
        lamps.push_back(lamp);
        const Vec3f at = warp_sphere(random_2d(41, i)) * 3.f;
        if (i % 3)
            lights.push_back(PointLight{at, {1, 1, 1}, 1e9f, lamp});
        else
            lights.push_back(SphereLight{{at, 0.05f}, {100, 100, 100}, lamp});
    }
    const LightSet set(lights, std::nullopt, LightChoice::tree, {}, {{cone, skewed}, {}});
    for (int p = 0; p < 20; ++p) {
        const Vec3f position = warp_sphere(random_2d(43, p)) * 1.5f;
        double expected = 0, found = 0, squares = 0;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            Vec3f from{};
            float strength = 1;
            if (const auto* point = std::get_if<PointLight>(&lights[i])) from = point->position;
            if (const auto* ball = std::get_if<SphereLight>(&lights[i]))
                from = ball->shape.center, strength = 100 * kPi * 0.05f * 0.05f;
            const Vec3f to = position - from;
            const LightProfile& profile = i % 2 ? *skewed : *cone;
            expected += strength * profile.at(lamps[i].local(normalize(to))).x / length_squared(to);
        }
        const int n = 20000;
        for (int i = 0; i < n; ++i) {
            const auto s = set.sample(float(hash_uniform(47, i)), random_2d(53, i), position, 0, white());
            const double v = s ? s->radiance[0] / s->pdf : 0;
            found += v / n, squares += v * v / n;
        }
        const double sigma = std::sqrt(std::max(0.0, squares - found * found) / n);
        CHECK(std::abs(found - expected) < 5 * sigma + 0.01 * expected);
    }
}
