// Mixtures in a closed furnace: each vertex of a path chooses a part for itself, whatever finds its light.
#include <doctest/doctest.h>

#include "math/statistics.h"
#include "transport/path.h"

namespace dg {
namespace {

/// A closed cube of half side 1 around the origin, made of the last of some materials.
std::shared_ptr<const Scene> cube_of(std::vector<Material> materials) {
    SceneDescription d;
    Mesh cube;
    std::vector<Vec3f> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
    cube.positions = corners;
    cube.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    d.meshes.push_back(cube);
    d.instances.push_back({"cube", 0, std::uint32_t(materials.size() - 1), {}});
    d.materials = std::move(materials);
    return Scene::build(std::move(d));
}

/// Luminances of n paths from the middle, in all directions.
SampleMoments look(const Scene& scene, PathSettings::Strategy strategy, int n) {
    PathSettings settings;
    settings.max_depth = 200;
    settings.strategy = strategy;
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
    // Were a path of one part all the way, it would be the mean of 1 and 5 instead.
    const auto scene = cube_of({grey(0), grey(0.8f), shining(mixed(0, 1, 0.5f))});
    using Strategy = PathSettings::Strategy;
    for (const auto strategy : {Strategy::mis, Strategy::light, Strategy::bsdf}) {
        const SampleMoments m = look(*scene, strategy, 40000);
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
        CHECK(agrees(look(*scene, strategy, 40000), 1 / (1 - albedo)));
}

TEST_CASE("of what is partly not there, each part counts by what is there of it") {
    // Walls stop 1 or 0.5 of the rays; beyond them is nothing: R = a (1 + p R).
    const auto scene = cube_of({grey(0), grey(0.8f, 0.5f), shining(mixed(0, 1, 0.5f))});
    const double stopped = 0.75, albedo = 0.8 * 0.25 / 0.75;
    for (const auto strategy : {PathSettings::Strategy::mis, PathSettings::Strategy::bsdf})
        CHECK(agrees(look(*scene, strategy, 60000), stopped / (1 - stopped * albedo)));
    CHECK_FALSE(agrees(look(*scene, PathSettings::Strategy::bsdf, 60000), stopped / (1 - stopped * 0.4)));
}

TEST_CASE("a boundary is not there") {
    Material boundary{"boundary", BoundaryMaterial{}};
    const auto scene = cube_of({shining(boundary)});   // seen once on the way to nothing
    CHECK(agrees(look(*scene, PathSettings::Strategy::bsdf, 2000), 1));
}

}  // namespace dg
