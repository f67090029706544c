// The path tracer without camera and film, in closed scenes of known radiance.
#include "transport/path.h"

#include <doctest/doctest.h>

#include "transport/test_furnace.h"

namespace dg {
namespace {

Material shining(float albedo, float luminance) {
    return {"wall", DiffuseMaterial{{albedo, albedo, albedo}}, {luminance, luminance, luminance}, true};
}

}  // namespace

TEST_CASE("in a closed furnace the radiance is emission / (1 - albedo), by every strategy") {
    // Every bounce adds the emission times the albedo so far: 1 + a + a^2 + ...
    for (const float albedo : {0.f, 0.5f, 0.8f}) {
        const auto scene = cube_of({shining(albedo, 1)});
        for (const auto strategy : {PathSettings::Strategy::mis, PathSettings::Strategy::light,
                                    PathSettings::Strategy::bsdf}) {
            PathSettings settings;
            settings.max_depth = 200;
            settings.strategy = strategy;
            const SampleMoments m = look(*scene, settings, 40000);
            CHECK(agrees(m, 1 / (1 - albedo)));
            // Light sampling alone is too noisy in the corners to detect 4 %.
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
    const auto scene = cube_of({{"lamp", lamp, {}, false}});
    PathSettings settings;
    settings.max_depth = 30;
    const SampleMoments mis = look(*scene, settings, 60000);
    for (const auto strategy : {PathSettings::Strategy::light, PathSettings::Strategy::bsdf}) {
        settings.strategy = strategy;
        CHECK(welch_p_value(mis, look(*scene, settings, 60000)) > 1e-4);
    }
}

TEST_CASE("Russian roulette does not darken, wherever it begins") {
    const auto scene = cube_of({shining(0.8f, 1)});
    for (const int depth : {1, 3, 8, 300}) {
        PathSettings settings;
        settings.max_depth = 250;
        settings.roulette_depth = depth;
        CHECK(agrees(look(*scene, settings, 40000), 5));
    }
}

TEST_CASE("a path of limited depth leaves out exactly the later bounces") {
    const auto scene = cube_of({shining(0.5f, 1)});
    PathSettings settings;
    settings.roulette_depth = 100;
    for (const int depth : {1, 2, 4}) {
        settings.max_depth = depth;
        CHECK(agrees(look(*scene, settings, 40000), 2 - std::pow(0.5, depth)));
    }
}

TEST_CASE("a ray that is no ray becomes a bad sample, not a crash") {
    const auto scene = cube_of({shining(0.5f, 1)});
    PathSampler sampler(0, 0, 0, 0);
    Wavelengths wavelengths = Wavelengths::sample(0.5f);
    Ray ray;
    ray.direction = {std::nanf(""), 0, 1};
    CHECK(std::isnan(radiance(*scene, ray, wavelengths, sampler, {}, nullptr, nullptr).any_hero[0]));
    ray.direction = {0, 0, 1};
    ray.origin = {0, std::numeric_limits<float>::infinity(), 0};
    CHECK(std::isnan(radiance(*scene, ray, wavelengths, sampler, {}, nullptr, nullptr).any_hero[0]));
}

TEST_CASE("the same numbers give the same radiance") {
    const auto scene = cube_of({shining(0.5f, 1)});
    CHECK(look(*scene, {}, 1000).mean == look(*scene, {}, 1000).mean);
}

}  // namespace dg
