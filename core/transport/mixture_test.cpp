// Mixtures in a closed furnace: each vertex of a path chooses a part independently, for every sampling strategy.
#include <doctest/doctest.h>

#include "transport/test_furnace.h"

namespace dg {
namespace {

PathSettings by(PathSettings::Strategy strategy) {
    PathSettings settings;
    settings.max_depth = 200;
    settings.strategy = strategy;
    return settings;
}

Material grey(float albedo, float opacity = 1) {
    Material m{"grey", DiffuseMaterial{{albedo, albedo, albedo}}};
    m.opacity = opacity;
    return m;
}
Material mirror(float albedo) { return {"mirror", ConductorMaterial{{albedo, albedo, albedo}, 0}}; }
Material mixed(std::uint32_t first, std::uint32_t second, float amount) {
    return {"mixture", MixMaterial{first, second, amount}};
}
Material shining(Material m) {
    m.emission = {1, 1, 1};
    m.two_sided_emission = true;
    return m;
}

}  // namespace

TEST_CASE("in a furnace of a mixture the radiance is that of the mean albedo, by every strategy") {
    // If a path chose its part once for all vertices, the result would be the mean of 1 and 5.
    const auto scene = cube_of({grey(0), grey(0.8f), shining(mixed(0, 1, 0.5f))});
    using Strategy = PathSettings::Strategy;
    for (const auto strategy : {Strategy::mis, Strategy::light, Strategy::bsdf}) {
        const SampleMoments m = look(*scene, by(strategy), 40000);
        CHECK(agrees(m, 1 / (1 - 0.4)));
        CHECK_FALSE(agrees(m, 3));
        if (strategy != Strategy::light) CHECK_FALSE(agrees(m, 1.04 / (1 - 0.4)));
    }
}

TEST_CASE("mixtures of mixtures, of mirrors too") {
    const auto scene =
        cube_of({grey(0.2f), mirror(0.9f), grey(0.6f), mixed(0, 1, 0.5f), shining(mixed(3, 2, 0.2f))});
    const double albedo = 0.8 * (0.5 * 0.2 + 0.5 * 0.9) + 0.2 * 0.6;
    for (const auto strategy : {PathSettings::Strategy::mis, PathSettings::Strategy::bsdf})
        CHECK(agrees(look(*scene, by(strategy), 40000), 1 / (1 - albedo)));
}

TEST_CASE("of what is partly not there, each part counts by what is there of it") {
    // Walls stop all or half of the rays, and the world outside is black: R = a (1 + p R).
    const auto scene = cube_of({grey(0), grey(0.8f, 0.5f), shining(mixed(0, 1, 0.5f))});
    const double stopped = 0.75, albedo = 0.8 * 0.25 / 0.75;
    for (const auto strategy : {PathSettings::Strategy::mis, PathSettings::Strategy::bsdf})
        CHECK(agrees(look(*scene, by(strategy), 60000), stopped / (1 - stopped * albedo)));
    CHECK_FALSE(agrees(look(*scene, by(PathSettings::Strategy::bsdf), 60000), stopped / (1 - stopped * 0.4)));
}

TEST_CASE("a boundary is not there") {
    Material boundary{"boundary", BoundaryMaterial{}};
    const auto scene = cube_of({shining(boundary)});   // each path passes it once
    CHECK(agrees(look(*scene, by(PathSettings::Strategy::bsdf), 2000), 1));
}

}  // namespace dg
