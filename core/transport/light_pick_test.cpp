// Resampled direct lighting: the same mean as with one light sample, and less noise.
#include "transport/light_pick.h"

#include <doctest/doctest.h>

#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

using Strategy = PathSettings::Strategy;
constexpr Vec3f kMiddle{0.1f, 0, 0.5f};

/// Faces up.
Mesh floor() {
    Mesh mesh;
    mesh.positions = {{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// Two triangles around a point, the second facing away.
Mesh sign(Vec3f at, float size) {
    Mesh mesh;
    mesh.positions = {at, at + Vec3f{size, 0, 0}, at + Vec3f{0, size, size}, at + Vec3f{0, 0.5f * size, -size}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
    return mesh;
}

/// An emitter with directional emission: its coat transmits less at grazing angles.
Material coated(Rgb emission) {
    GltfMaterial m;
    m.base_color = {0, 0, 0};
    m.clearcoat.factor = 1;
    m.double_sided = true;
    m.emissive = emission;
    return {"sign", m};
}

/// Spheres and triangles around a floor, some behind a wall, with a sun and a sky of two colours.
std::shared_ptr<const Scene> many_lamps(const Material& ground, bool small = false) {
    SceneDescription d;
    add(d, floor(), ground);
    const float size = small ? 0.03f : 0.3f;
    for (int i = 0; i < 9; ++i) {
        const Vec3f at{float(i % 3) - 1, 0.3f + 0.2f * float(i), float(i / 3) - 1};
        const float strength = (1 + float(i)) * (small ? 100.f : 1.f);
        d.lights.push_back(SphereLight{{at, 0.3f * size}, {strength, 3, 1}});
        add(d, sign(at + Vec3f{0.4f, 0.2f, 0.3f}, size), coated({2, strength, 3}));
    }
    d.lights.push_back(DirectionalLight{normalize(Vec3f{1, -1, 0.3f}), {0.5f, 0.5f, 0.5f}});
    const EnvironmentImage sky{2, 2, {{1, 0, 0}, {0, 1, 0}, {0, 0.2f, 0.2f}, {1, 1, 0}}};
    d.environment = Environment::image(sky, 1, {});
    return Scene::build(std::move(d));
}

/// Five coated lamps around a point of the floor, at grazing angles; two of them face away.
std::shared_ptr<const Scene> few_lamps() {
    SceneDescription d;
    add(d, floor(), {"matte", DiffuseMaterial{{0.8f, 0.6f, 0.4f}}});
    for (int i = 0; i < 5; ++i) {
        const float angle = 1.2566f * float(i) + 0.2f, strength = 1 + 2 * float(i % 3);
        const Vec3f away{std::cos(angle), 0, std::sin(angle)}, aside{-away.z, 0, away.x};
        const Vec3f at = kMiddle + away + Vec3f{0, 0.3f, 0}, along = away * 0.8f + aside * 0.12f;
        Mesh lamp;
        lamp.positions = {at, at + along, at + along * 0.5f + Vec3f{0, 0.8f, 0}};
        lamp.triangles = {{0, 1, 2}};
        add(d, lamp, coated({strength, strength, strength}));
        if (i > 1) continue;
        Mesh wall;
        const Vec3f by = kMiddle + away * 0.5f;
        wall.positions = {by - aside, by + aside, by + Vec3f{0, 3, 0}};
        wall.triangles = {{0, 1, 2}};
        add(d, wall, {"wall", DiffuseMaterial{{0, 0, 0}}});
    }
    return Scene::build(std::move(d));
}

/// Radiances of paths to a point of the floor, each the mean over its wavelengths.
SampleMoments look(const Scene& scene, Strategy strategy, int depth, int seed, int n = 60000,
                   Vec3f from = {0, 1, 4}) {
    std::vector<double> found(n);
    PathSettings settings;
    settings.max_depth = depth;
    settings.strategy = strategy;
    for (int i = 0; i < n; ++i) {
        PathSampler sampler(i, 0, 0, seed);
        const Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        Ray ray;
        ray.origin = from;
        ray.direction = normalize(kMiddle - ray.origin);
        const Radiance light = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr);
        found[i] = light.sum().average();
    }
    return moments(found);
}

Material glossy() {
    GltfMaterial m;
    m.base_color = {0.4f, 0.2f, 0.1f};
    m.metallic = 0, m.roughness = 0.5f;
    return {"glossy", m};
}

}  // namespace

TEST_CASE("few lights are sampled one at a time") {
    std::vector<Light> lights(4, PointLight{{0, 1, 0}, {1, 1, 1}});
    CHECK(light_candidates(LightSet{}, true) == 0);
    CHECK(light_candidates(LightSet(lights, std::nullopt), true) == 1);
    lights.push_back(DirectionalLight{{0, -1, 0}, {1, 1, 1}});
    const LightSet many(lights, std::nullopt);
    CHECK(light_candidates(many, true) > light_candidates(many, false));
    CHECK(light_candidates(many, false) > 1);
}

TEST_CASE("picked light is the light that following the BSDF finds, at every depth") {
    const Material matte{"matte", DiffuseMaterial{{0.8f, 0.6f, 0.4f}}},
        metal{"metal", ConductorMaterial{{0.9f, 0.8f, 0.7f}, 0.3f}};
    for (const Material& ground : {matte, metal, glossy()}) {
        const auto scene = many_lamps(ground);
        for (const int depth : {1, 3}) {
            const SampleMoments both = look(*scene, Strategy::mis, depth, 1);
            CHECK(welch_p_value(both, look(*scene, Strategy::light, depth, 2)) > 1e-3);
            CHECK(welch_p_value(both, look(*scene, Strategy::bsdf, depth, 3, 150000)) > 1e-3);
        }
    }
}

TEST_CASE("picked light knows shadows, and from where a lamp is seen") {
    const auto scene = few_lamps();
    const Vec3f above = kMiddle + Vec3f{0.01f, 3, 0.02f};
    const SampleMoments picked = look(*scene, Strategy::light, 1, 1, 60000, above),
                        found = look(*scene, Strategy::bsdf, 1, 2, 400000, above);
    CHECK(welch_p_value(picked, found) > 1e-3);
    CHECK(std::abs(picked.mean / found.mean - 1) < 0.02);
}

TEST_CASE("what is left as noise is shadows, not the choice") {
    const auto scene = many_lamps(glossy(), true);
    const Material ground = glossy();
    std::vector<double> one, picked;
    for (int i = 0; i < 20000; ++i) {
        PathSampler sampler(i, 0, 0, 4);
        const Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        SurfaceHit hit;
        hit.position = {0.1f, 0, 0.5f}, hit.ng = hit.ns = {0, 1, 0}, hit.wo = normalize(Vec3f{0, 1, 4} - hit.position);
        hit.front = true;
        const Bsdf bsdf = shade(ground, {}, hit, wavelengths);
        const LightPick::Random u{sampler.next_1d(), sampler.next_2d(), sampler.next_1d()};
        const auto toward = [&](Vec3f wi) { return evaluate_with_pdf(bsdf, hit.wo, wi); };
        for (const int candidates : {1, 4}) {
            const auto found = LightPick::pick(*scene, hit, wavelengths, candidates, false, u, 1.f, toward);
            const double brought =
                found ? (found->f.f_cos * found->light.radiance * found->weight).average() : 0;
            (candidates == 1 ? one : picked).push_back(brought);
        }
    }
    const SampleMoments a = moments(one), b = moments(picked);
    CHECK(welch_p_value(a, b) > 1e-3);
    CHECK(b.variance < 0.45 * a.variance);
}

}  // namespace dg
