// The path tracer without camera and film: closed worlds whose radiance is known.
#include "transport/path.h"

#include <doctest/doctest.h>

#include "math/statistics.h"

namespace dg {
namespace {

/// A closed cube of half side 1 around the origin; every wall reflects and shines evenly.
std::shared_ptr<const Scene> furnace(Material material) {
    SceneDescription d;
    Mesh cube;
    cube.name = "cube";
    std::vector<Vec3f> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
    cube.positions = corners;
    cube.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    d.meshes.push_back(cube);
    d.materials.push_back(std::move(material));
    d.instances.push_back({"cube", 0, 0, {}});
    return Scene::build(std::move(d));
}

Material shining(float albedo, float luminance) {
    return {"wall", DiffuseMaterial{{albedo, albedo, albedo}}, {luminance, luminance, luminance}, true};
}

/// Luminances of n paths from the middle, in all directions.
SampleMoments look(const Scene& scene, const PathSettings& settings, int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        PathSampler sampler(i % 64, i / 64, 0, 7);
        Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        const Vec2f u = sampler.next_2d();
        const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
        Ray ray;
        ray.direction = normalize(Vec3f{r * std::cos(phi), r * std::sin(phi), z});
        const Spectrum l = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr).sum();
        values.push_back(wavelengths.to_xyz(l).y);
    }
    return moments(values);
}

bool agrees(const SampleMoments& m, double expected) {
    return std::abs(m.mean - expected) < 4 * std::sqrt(m.variance / m.count) + 1e-3 * expected;
}

}  // namespace

TEST_CASE("in a closed furnace the radiance is emission / (1 - albedo), by every strategy") {
    // Every bounce adds the emission times the albedo so far: 1 + a + a^2 + ...
    for (const float albedo : {0.f, 0.5f, 0.8f}) {
        const auto scene = furnace(shining(albedo, 1));
        for (const auto strategy : {PathSettings::Strategy::mis, PathSettings::Strategy::light,
                                    PathSettings::Strategy::bsdf}) {
            PathSettings settings;
            settings.max_depth = 200;
            settings.strategy = strategy;
            const SampleMoments m = look(*scene, settings, 40000);
            CHECK(agrees(m, 1 / (1 - albedo)));
            // Light sampling alone is too noisy in the corners to tell 4 % apart.
            if (strategy != PathSettings::Strategy::light)
                CHECK_FALSE(agrees(m, 1.04 / (1 - albedo)));
        }
    }
}

TEST_CASE("a coated lamp is dimmed by the angle it is seen from, by every strategy") {
    GltfMaterial lamp;
    lamp.base_color = {0.3f, 0.3f, 0.3f};
    lamp.metallic = lamp.specular = 0;
    lamp.emissive = {1, 1, 1};
    lamp.double_sided = true;
    lamp.clearcoat.factor = 1;
    lamp.clearcoat.roughness = 1;
    const auto scene = furnace({"lamp", lamp, {}, false});
    PathSettings settings;
    settings.max_depth = 30;
    const SampleMoments mis = look(*scene, settings, 60000);
    for (const auto strategy : {PathSettings::Strategy::light, PathSettings::Strategy::bsdf}) {
        settings.strategy = strategy;
        CHECK(welch_p_value(mis, look(*scene, settings, 60000)) > 1e-4);
    }
}

TEST_CASE("Russian roulette does not darken, wherever it begins") {
    const auto scene = furnace(shining(0.8f, 1));
    for (const int depth : {1, 3, 8, 300}) {
        PathSettings settings;
        settings.max_depth = 250;
        settings.roulette_depth = depth;
        CHECK(agrees(look(*scene, settings, 40000), 5));
    }
}

TEST_CASE("a path of limited depth leaves out exactly the later bounces") {
    const auto scene = furnace(shining(0.5f, 1));
    PathSettings settings;
    settings.roulette_depth = 100;
    for (const int depth : {1, 2, 4}) {
        settings.max_depth = depth;
        CHECK(agrees(look(*scene, settings, 40000), 2 - std::pow(0.5, depth)));
    }
}

TEST_CASE("a ray that is no ray becomes a bad sample, not a crash") {
    const auto scene = furnace(shining(0.5f, 1));
    PathSampler sampler(0, 0, 0, 0);
    Wavelengths wavelengths = Wavelengths::sample(0.5f);
    Ray ray;
    ray.direction = {std::nanf(""), 0, 1};
    CHECK(std::isnan(radiance(*scene, ray, wavelengths, sampler, {}, nullptr, nullptr).shared[0]));
    ray.direction = {0, 0, 1};
    ray.origin = {0, std::numeric_limits<float>::infinity(), 0};
    CHECK(std::isnan(radiance(*scene, ray, wavelengths, sampler, {}, nullptr, nullptr).shared[0]));
}

TEST_CASE("the same numbers give the same radiance") {
    const auto scene = furnace(shining(0.5f, 1));
    CHECK(look(*scene, {}, 1000).mean == look(*scene, {}, 1000).mean);
}

}  // namespace dg
