// Catchers: radiance of objects, radiance of the set with objects and without them, and coverage.
#include <doctest/doctest.h>

#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

constexpr int kPaths = 60'000;
constexpr CatcherEffects kNone{false, false, false};

Mesh floor() {
    Mesh mesh;
    mesh.positions = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

Mesh ball(Vec3f at, float radius) {
    Mesh mesh = ball_mesh(2);
    std::vector<Vec3f> positions(mesh.positions.begin(), mesh.positions.end());
    for (Vec3f& p : positions) p = p * radius + at;
    mesh.positions = positions;
    return mesh;
}

Mesh upright(Vec3f at, float size) {
    Mesh mesh = quad_mesh();
    std::vector<Vec3f> positions(mesh.positions.begin(), mesh.positions.end());
    for (Vec3f& p : positions) p = p * size + at;
    mesh.positions = positions;
    return mesh;
}

Material matte(Rgb color, Rgb emission = {0, 0, 0}) { return {"matte", DiffuseMaterial{color}, emission, true}; }

Material glossy() {
    GltfMaterial m;
    m.base_color = {0.5f, 0.4f, 0.3f};
    m.metallic = 0.3f;
    m.roughness = 0.4f;
    m.clearcoat.factor = 0.5f;
    m.clearcoat.roughness = 0.3f;
    return {"glossy", m};
}

Material pane() {
    GltfMaterial m;
    m.base_color = {0.9f, 0.7f, 0.5f};
    m.metallic = m.roughness = 0;
    m.transmission = 1;
    m.double_sided = true;
    return {"pane", m};
}

/// Variants of the scene: without catchers, with catchers, or without the objects.
enum class Kind { plain, caught, empty };

struct Stage {
    Material ground = matte({0.6f, 0.5f, 0.4f});
    std::vector<std::pair<Mesh, Material>> objects;
    std::vector<Light> lights;
    bool wall = true;   // part of the set, behind the objects

    std::shared_ptr<const Scene> build(Kind kind, CatcherEffects effects = {}) const {
        SceneDescription d;
        add(d, floor(), ground);
        if (wall) add(d, upright({0, 1, -2}, 1), matte({0.3f, 0.6f, 0.3f}));
        const std::size_t real = d.instances.size();
        if (kind != Kind::empty)
            for (const auto& [mesh, material] : objects) add(d, mesh, material);
        if (kind == Kind::caught)
            for (std::size_t i = 0; i < real; ++i) d.instances[i].catcher = effects;
        d.lights = lights;
        d.environment = Environment::image({2, 2, {{2, 1, 1}, {1, 2, 1}, {0.2f, 0.2f, 0.2f}, {0.1f, 0.1f, 0.4f}}}, 1, {});
        return Scene::build(std::move(d));
    }
};

Stage stage_of(std::vector<std::pair<Mesh, Material>> objects) {
    Stage stage;
    stage.objects = std::move(objects);
    stage.lights.push_back(PointLight{{1, 2, 1}, {3, 3, 3}});
    stage.lights.push_back(SphereLight{{{-1, 1.5f, 0.5f}, 0.2f}, {20, 15, 10}});
    return stage;
}

std::vector<std::pair<const char*, Stage>> stages() {
    std::vector<std::pair<const char*, Stage>> all;
    const Mesh middle = ball({0, 0.5f, 0}, 0.5f);
    all.emplace_back("matte", stage_of({{middle, matte({0.8f, 0.2f, 0.2f})}}));
    all.emplace_back("glass", stage_of({{middle, {"glass", DielectricMaterial{1.5f, 0}}}}));
    all.emplace_back("lamp", stage_of({{middle, matte({0.5f, 0.5f, 0.5f}, {3, 2, 1})}}));
    all.emplace_back("pane", stage_of({{upright({0, 0.9f, 0.6f}, 0.8f), pane()}, {middle, matte({0.2f, 0.2f, 0.8f})}}));
    Stage glossy_floor = stage_of({{middle, matte({0.8f, 0.2f, 0.2f}, {0.5f, 0.2f, 0.2f})}});
    glossy_floor.ground = glossy();
    all.emplace_back("glossy floor", glossy_floor);
    Stage many = stage_of({{middle, matte({0.8f, 0.2f, 0.2f})}});
    for (int i = 0; i < 6; ++i) many.lights.push_back(SphereLight{{{float(i) - 2.5f, 2, 1}, 0.1f}, {9, float(i), 5}});
    for (int i = 0; i < 3; ++i) many.objects.push_back({ball({0.3f * float(i), 1.4f, 0.4f}, 0.1f), matte({0, 0, 0}, {5, 5, 5})});
    all.emplace_back("many lamps", many);
    return all;
}

/// Camera ray i; the rays cover objects, ground and sky.
Sight look_at(const Scene& scene, int i, const PathSettings& settings, std::uint64_t seed = 3) {
    PathSampler sampler(i, 0, 0, seed);
    const CameraRandom u = sampler.camera();
    const Ray ray = test_ray({0, 1, 3}, {1.4f * (u.film.x - 0.5f), -0.35f + 0.7f * (u.film.y - 0.5f), -1});
    // Reduces four wavelengths to their mean, so that sums over paths are comparable.
    return trace_camera_ray(scene, ray, Wavelengths::sample(u.lambda), sampler, settings, nullptr, nullptr);
}

struct Sums {
    std::vector<double> light, with, without, difference, covered;
};

Sums all_of(const Scene& scene, std::uint64_t seed, PathSettings settings = {}) {
    Sums sums;
    for (int i = 0; i < kPaths; ++i) {
        const Sight s = look_at(scene, i, settings, seed);
        const double with = s.with_objects.sum().average(), without = s.without_objects.sum().average();
        sums.light.push_back(s.light.sum().average());
        sums.with.push_back(s.light.sum().average() + with);
        sums.without.push_back(without);
        sums.difference.push_back(with - without);
        sums.covered.push_back(s.covers.sum());
    }
    return sums;
}

double p_value(const std::vector<double>& a, const std::vector<double>& b) { return welch_p_value(moments(a), moments(b)); }

}  // namespace

TEST_CASE("objects and set are the picture together, and the set alone is the picture without objects") {
    for (const auto& [name, stage] : stages()) {
        CAPTURE(name);
        const Sums caught = all_of(*stage.build(Kind::caught), 3);
        CHECK(p_value(caught.with, all_of(*stage.build(Kind::plain), 4).light) > 1e-3);
        CHECK(p_value(caught.without, all_of(*stage.build(Kind::empty), 5).light) > 1e-3);
    }
}

TEST_CASE("a set without objects sends the same with and without them, to the bit") {
    Stage stage = stage_of({});
    stage.ground = glossy();
    const auto caught = stage.build(Kind::caught), plain = stage.build(Kind::plain);
    for (int i = 0; i < 2000; ++i) {
        const Sight a = look_at(*caught, i, {}), b = look_at(*plain, i, {});
        for (int k = 0; k < kWavelengths; ++k) {
            CHECK(a.with_objects.sum()[k] == a.without_objects.sum()[k]);
            CHECK(a.with_objects.sum()[k] == b.light.sum()[k]);
            CHECK(a.light.sum()[k] == 0);
        }
        CHECK(a.covers.sum() == 0);
    }
}

TEST_CASE("effects add up to the whole difference, and without them there is none") {
    for (const auto& [name, stage] : stages()) {
        if (name != std::string("glossy floor") && name != std::string("lamp") && name != std::string("pane")) continue;
        CAPTURE(name);
        const auto difference = [&](CatcherEffects effects, std::uint64_t seed) {
            const Sums sums = all_of(*stage.build(Kind::caught, effects), seed);
            CHECK(p_value(sums.without, all_of(*stage.build(Kind::empty), 9).light) > 1e-3);
            return moments(sums.difference);
        };
        // Both sides are sums over the whole view, and contain the light of the set behind objects once.
        const SampleMoments all = difference({}, 3), none = difference(kNone, 4),
                            shadow = difference({true, false, false}, 5),
                            reflection = difference({false, true, false}, 6), gi = difference({false, false, true}, 7);
        const double parts = shadow.mean + reflection.mean + gi.mean - 2 * none.mean;
        double variance = all.variance + shadow.variance + reflection.variance + gi.variance + 4 * none.variance;
        CHECK(std::abs(parts - all.mean) < 3.5 * std::sqrt(variance / kPaths));
        CHECK(std::abs(shadow.mean - none.mean) > 4 * std::sqrt((shadow.variance + none.variance) / kPaths));
    }
}

TEST_CASE("what the lens looks past an object to is covered by its share") {
    // A pane in front of the sky, and a ball behind the pane.
    const Stage stage = stages()[3].second;
    const auto scene = stage.build(Kind::caught);
    const std::uint32_t pane = 2, behind = 3;
    double of_pane = 0, of_ball = 0;
    int rays = 0;
    for (int i = 0; i < kPaths; ++i) {
        PathSampler sampler(i, 0, 0, 8);
        const Wavelengths w = Wavelengths::sample(sampler.camera().lambda);
        const Sight s = trace_camera_ray(*scene, test_ray({0, 0.5f, 3}, {0, 0, -1}), w, sampler, {}, nullptr, nullptr);
        CHECK(s.covers.sum() == doctest::Approx(1).epsilon(0.01));
        for (const Cover& c : s.covers) (c.instance == pane ? of_pane : of_ball) += c.share;
        for (const Cover& c : s.covers) CHECK((c.instance == pane || c.instance == behind));
        ++rays;
    }
    // The sheet passes (1 - r)^2 / (1 - r^2) of its colour, at 4 % Fresnel reflectance, on average.
    CHECK(of_ball / rays > 0.5);
    CHECK(of_ball / rays < 0.8);
    CHECK(of_pane / rays == doctest::Approx(1 - of_ball / rays).epsilon(0.01));
}

TEST_CASE("smooth glass covers what is behind it, or lets it pass unbent") {
    const Stage stage = stages()[1].second;
    PathSettings through;
    through.see_through = true;
    through.splits = 0;
    const auto scene = stage.build(Kind::caught);
    double opaque = 0, open = 0, with = 0, expected = 0;
    for (int i = 0; i < kPaths; ++i) {
        PathSampler sampler(i, 0, 0, 8), same(i, 0, 0, 8);
        const Wavelengths w = Wavelengths::sample(sampler.camera().lambda);
        same.camera();
        const Ray ray = test_ray({0.05f, 0.55f, 3}, {0, 0, -1});
        opaque += trace_camera_ray(*scene, ray, w, sampler, {}, nullptr, nullptr).covers.sum();
        const Sight s = trace_camera_ray(*scene, ray, w, same, through, nullptr, nullptr);
        open += 1 - s.covers.sum();
        with += s.with_objects.sum().average();
        expected += s.without_objects.sum().average();
    }
    CHECK(opaque / kPaths == doctest::Approx(1).epsilon(1e-4));
    const double passed = open / kPaths;
    CHECK(passed > 0.88);
    CHECK(passed < 0.96);
    CHECK(with == doctest::Approx(passed * expected).epsilon(0.03));
}

TEST_CASE("a transparent background takes the sky from what the lens sees, and from nothing else") {
    Stage stage = stage_of({{ball({0, 0.5f, 0}, 0.5f), matte({0.8f, 0.2f, 0.2f})}});
    stage.wall = false;
    const auto scene = stage.build(Kind::plain);
    PathSettings clear;
    clear.background = Background::transparent;
    int sky = 0, covered = 0;
    for (int i = 0; i < 4000; ++i) {
        const Sight all = look_at(*scene, i, {}), none = look_at(*scene, i, clear);
        CHECK(all.covers.sum() == none.covers.sum());
        for (int k = 0; k < kWavelengths; ++k)
            CHECK(none.light.sum()[k] == (all.covers.sum() > 0 ? all.light.sum()[k] : 0));
        (all.covers.sum() > 0 ? covered : sky)++;
    }
    CHECK(std::min(sky, covered) > 100);
}

}  // namespace dg
