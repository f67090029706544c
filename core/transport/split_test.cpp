// Paths that follow both lobes of the first smooth clear interfaces: the same mean, with less noise.
#include <doctest/doctest.h>

#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

Mesh cube(float size, Vec3f middle) {
    Mesh mesh;
    std::vector<Vec3f> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(middle + Vec3f{i & 1 ? size : -size, i & 2 ? size : -size, i & 4 ? size : -size});
    mesh.positions = corners;
    mesh.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 7, 6}, {4, 5, 7}, {0, 5, 4}, {0, 1, 5},
                      {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 7, 5}, {1, 3, 7}};
    return mesh;
}

/// Faces up, or down.
Mesh floor(float y, bool up = true) {
    Mesh mesh;
    const float x = up ? 9 : -9;
    mesh.positions = {{-x, y, -9}, {-x, y, 9}, {x, y, 9}, {x, y, -9}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

Material clear(float dispersion) { return {"glass", DielectricMaterial{1.5f, 0, {0.9f, 0.8f, 0.7f}, dispersion}}; }

Material tumbler(Rgb color) {
    GltfMaterial m;
    m.base_color = color;
    m.metallic = m.roughness = 0;
    m.transmission = m.thickness = 1;
    return {"tumbler", m};
}

/// Two blocks of glass in a row, on a floor under a lamp and a grey sky.
std::shared_ptr<const Scene> blocks(const Material& glass, bool mirror = false) {
    SceneDescription d;
    add(d, cube(0.5f, {0, 0, -2}), glass);
    add(d, cube(0.4f, {0.1f, 0, -4}), glass);
    add(d, floor(-0.6f), {"floor", DiffuseMaterial{{0.7f, 0.5f, 0.3f}}});
    if (mirror) add(d, cube(0.2f, {0.05f, 0.25f, -0.8f}), {"mirror", ConductorMaterial{}});
    d.lights.push_back(SphereLight{{{0.3f, 1.5f, -3}, 0.3f}, {50, 50, 50}});
    d.environment = Environment::constant({0.5f, 0.5f, 0.5f});
    return Scene::build(std::move(d));
}

/// Plane glass from y = -1 to -1.1 under a white sky.
std::shared_ptr<const Scene> slab(const Material& glass) {
    SceneDescription d;
    add(d, floor(-1), glass);
    add(d, floor(-1.1f, false), glass);
    d.environment = Environment::constant({1, 1, 1});
    return Scene::build(std::move(d));
}

/// Radiance of a path down to the slab at 45 degrees, relative to the sky, for each wavelength.
Radiance look_down(const Scene& scene, int depth, int i, int splits = 5) {
    PathSampler sampler(i, 0, 0, 7);
    const Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
    PathSettings settings;
    settings.splits = splits;
    settings.max_depth = depth;
    settings.roulette_depth = 100;
    Ray ray;
    ray.direction = normalize(Vec3f{0, -1, -1});
    Radiance light = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr);
    const Spectrum sky = wavelengths.emission({1, 1, 1});
    for (Spectrum* s : {&light.any_hero, &light.hero})
        for (int k = 0; k < kWavelengths; ++k) s->set(k, (*s)[k] / sky[k]);
    return light;
}

/// Fresnel reflectance of a refractive index at 45 degrees.
double reflectance(double n) {
    const double in = std::sqrt(0.5), out = std::sqrt(1 - 0.5 / (n * n));
    const double s = (in - n * out) / (in + n * out), p = (n * in - out) / (n * in + out);
    return (s * s + p * p) / 2;
}

/// Luminances of paths into the scene, near the axis.
SampleMoments look(const Scene& scene, int splits, std::uint64_t seed) {
    PathSettings settings;
    settings.splits = splits;
    settings.max_depth = 5;
    std::vector<double> values;
    for (int i = 0; i < 60000; ++i) {
        PathSampler sampler(i, 0, 0, seed);
        const Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        const Vec2f u = sampler.next_2d();
        Ray ray;
        ray.direction = normalize(Vec3f{0.3f * (u.x - 0.5f), 0.3f * (u.y - 0.5f), -1});
        const Radiance light = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr);
        values.push_back(wavelengths.to_xyz(light.sum()).y);
    }
    return moments(values);
}

}  // namespace

TEST_CASE("each path brings what a slab reflects and what it lets through, to the depth that it has") {
    const double r = reflectance(1.5), t2 = (1 - r) * (1 - r);
    Material grey = tumbler({1, 1, 1});
    std::get<GltfMaterial>(grey.kind).attenuation_color = {0.5f, 0.5f, 0.5f};
    std::get<GltfMaterial>(grey.kind).attenuation_distance = 0.1f / std::sqrt(1 - 0.5f / 2.25f);   // once across
    for (const auto& [glass, a] : {std::pair{Material{"glass", DielectricMaterial{1.5f}}, 1.}, {grey, 0.5}}) {
        const auto scene = slab(glass);
        double expected = r, through = t2 * a;
        for (int depth = 1; depth <= 4; ++depth) {
            for (int i = 0; i < 20; ++i)
                for (int k = 0; k < kWavelengths; ++k)
                    CHECK(look_down(*scene, depth, i).sum()[k] == doctest::Approx(expected).epsilon(1e-4));
            expected += through;
            through *= r * a;
        }
    }
}

TEST_CASE("where a coat is a third way, one is drawn") {
    Material coated = tumbler({1, 1, 1});
    std::get<GltfMaterial>(coated.kind).clearcoat.factor = 1;
    const auto scene = slab(coated);
    for (int i = 0; i < 20; ++i) CHECK(look_down(*scene, 4, i).sum()[0] == look_down(*scene, 4, i, 0).sum()[0]);
}

TEST_CASE("what dispersive glass reflects belongs to all wavelengths, what it bends to the hero") {
    const auto scene = slab({"glass", DielectricMaterial{1.5f, 0, {1, 1, 1}, 8}});
    for (int i = 0; i < 20; ++i) {
        const Radiance reflected = look_down(*scene, 1, i), both = look_down(*scene, 2, i);
        CHECK(reflected.hero.is_black());
        for (int k = 0; k < kWavelengths; ++k) {
            CHECK(reflected.any_hero[k] == doctest::Approx(reflectance(1.5)).epsilon(0.2));
            CHECK(both.any_hero[k] == reflected.any_hero[k]);
        }
        const double r = reflected.any_hero[0];
        CHECK(both.hero.average() == doctest::Approx((1 - r) * (1 - r)).epsilon(1e-4));
    }
}

TEST_CASE("both ways bring the light of one that is drawn, in smooth glass of any kind") {
    const Material blue = tumbler({0.8f, 0.9f, 1});
    for (const auto& scene : {blocks(clear(0)), blocks(clear(8)), blocks(blue), blocks(clear(0), true)})
        CHECK(welch_p_value(look(*scene, 0, 7), look(*scene, 2, 8)) > 1e-3);
}

}  // namespace dg
