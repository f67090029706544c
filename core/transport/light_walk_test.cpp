// Light walks without camera and film: they bring as much light to a point as paths from the point find.
#include "transport/light_walk.h"

#include <doctest/doctest.h>

#include <numeric>

#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/test_furnace.h"

namespace dg {
namespace {

constexpr int kPaths = 60000;
const Vec3f kPoint{-0.3f, -0.2f, 0.5f};

/// A closed cube [-1, 1]^3 with a lamp inside.
SceneDescription describe_room(Light lamp, Material wall) {
    SceneDescription d;
    d.meshes.push_back(closed_cube());
    d.materials.push_back(std::move(wall));
    d.instances.push_back({"cube", 0, 0, {}});
    d.lights.push_back(std::move(lamp));
    return d;
}
std::shared_ptr<const Scene> room(Light lamp, Material wall) {
    return Scene::build(describe_room(std::move(lamp), std::move(wall)));
}

/// The cube filled with absorbing fog, with a ball of another absorbing medium, on a grid or homogeneous.
std::shared_ptr<const Scene> foggy_room(Light lamp, Material wall, bool grid) {
    SceneDescription d = describe_room(std::move(lamp), std::move(wall));
    add(d, ball_mesh(3), {"boundary", DiffuseMaterial{}});
    d.instances.back().world_from_local = {{0.4f, 0, 0}, {0, 0.4f, 0}, {0, 0, 0.4f}, {0.1f, 0, 0.1f}};
    Medium fog{{0.2f, 0.3f, 0.4f}, {}, {}, Phase()}, ball{{0.5f, 1, 2}, {}, {}, Phase()};
    const Affine3d box{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {-1, -1, -1}};
    const DensityGrid halves({2, 1, 1}, std::vector{2.f, 0.1f}, box);
    if (grid) ball.density = std::make_shared<const DensityGrid>(halves);
    d.media.all = {std::make_shared<const Medium>(fog), std::make_shared<const Medium>(ball)};
    d.media.fog = 0;
    d.media.of_material[1] = {1, -1, true};
    return Scene::build(std::move(d));
}

/// Integral over directions of the radiance at the point that was scattered by two surfaces or more.
SampleMoments by_paths(const Scene& scene, PathSettings settings) {
    std::vector<double> values;
    for (int i = 0; i < kPaths; ++i) {
        PathSampler sampler(i % 256, i / 256, 0, 7);
        Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        const Ray ray = test_ray(kPoint, test_direction(i));
        PathSampler again = sampler;
        PathSettings direct = settings;
        direct.max_depth = 1;
        const Spectrum all = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr).sum();
        const Spectrum near = radiance(scene, ray, wavelengths, again, direct, nullptr, nullptr).sum();
        values.push_back(4 * kPiD * (wavelengths.to_xyz(all).y - wavelengths.to_xyz(near).y));
    }
    return moments(values);
}

/// Light that walks send to the point, by connections with a density of distance squared, 1/sr.
SampleMoments by_walks(const Scene& scene, const PathSettings& settings) {
    const EmissionSampler none;
    const EmissionRays rays(scene.lights(), scene.emission_reach());
    const LightSharing sharing({0, 1}, Technique::light, 1, &none, &rays);
    CHECK(sharing.bounces());
    std::vector<double> values;
    for (int i = 0; i < kPaths; ++i) {
        PathSampler sampler(i % 256, i / 256, 0, 11);
        const CameraRandom u = sampler.camera();
        LightWalk::Start start{u.film.x, sampler.next_2d(), u.lens, 0, Wavelengths::sample(u.lambda)};
        auto walk = LightWalk::begin(scene, sharing, settings, start, sampler);
        double sum = 0;
        while (walk) {
            const LightWalk::Random random = walk->draw();
            std::optional<LightVertex> vertex;
            if (!walk->meet(vertex)) break;
            if (walk->sends(*vertex)) {
                const Vec3f way = kPoint - vertex->hit().position, w = normalize(way);
                Ray shadow = spawn_ray(vertex->hit(), w, 0);
                shadow.t_max = length(way);
                if (const auto sent = walk->send(*vertex, w, dot(way, way)))
                    sum += walk->wavelengths()
                               .to_xyz(sent->radiance * scene.visibility_along(shadow, walk->wavelengths()))
                               .y / sharing.divisor(sent->density, 0);
            }
            if (!walk->go_on(*vertex, random)) break;
        }
        values.push_back(sum);
    }
    return moments(values);
}

}  // namespace

TEST_CASE("walks bring to a point the light that paths find there after two surfaces") {
    const Material wall{"wall", DiffuseMaterial{{0.6f, 0.6f, 0.6f}}};
    const SphereLight ball{{{0.4f, 0.3f, -0.2f}, 0.1f}, {20, 20, 20}};
    const PointLight point{{0.4f, 0.3f, -0.2f}, {0.7f, 0.7f, 0.7f}};
    PathSettings shallow;
    shallow.max_depth = 3;
    for (const Light& lamp : {Light(ball), Light(point)})
        for (const PathSettings& settings : {PathSettings{}, shallow}) {
            const auto scene = room(lamp, wall);
            SampleMoments a = by_paths(*scene, settings), b = by_walks(*scene, settings);
            INFO("paths ", a.mean, " walks ", b.mean);
            CHECK(a.mean > 0.1);
            CHECK(welch_p_value(a, b) > 1e-3);
            b.mean *= 1.05;   // the check detects 5 %
            CHECK(welch_p_value(a, b) < 1e-3);
        }
}

TEST_CASE("walks bring the light of paths through media that absorb") {
    const Material wall{"wall", DiffuseMaterial{{0.6f, 0.6f, 0.6f}}};
    const SphereLight lamp{{{0.1f, 0.1f, 0.1f}, 0.1f}, {20, 20, 20}};   // inside the ball
    for (const bool grid : {false, true}) {
        const auto clear = room(lamp, wall), foggy = foggy_room(lamp, wall, grid);
        SampleMoments a = by_paths(*foggy, {}), b = by_walks(*foggy, {});
        INFO("paths ", a.mean, " walks ", b.mean);
        CHECK(a.mean > 0.05);
        CHECK(a.mean < 0.6 * by_paths(*clear, {}).mean);
        CHECK(welch_p_value(a, b) > 1e-3);
        b.mean *= 1.05;
        CHECK(welch_p_value(a, b) < 1e-3);
    }
}

TEST_CASE("no light leaves where there is none, and a mirror alone sends none to a lens") {
    const auto dark = room(SphereLight{{{0, 0, 0}, 0.1f}, {0, 0, 0}}, {"wall", DiffuseMaterial{{0.5f, 0.5f, 0.5f}}});
    CHECK(EmissionRays(dark->lights(), dark->emission_reach()).empty());
    GltfMaterial mirror;
    mirror.metallic = 1, mirror.roughness = 0;
    const auto shiny = room(SphereLight{{{0.4f, 0.3f, -0.2f}, 0.1f}, {20, 20, 20}}, {"wall", mirror});
    CHECK(by_walks(*shiny, {}).mean == 0);
}

}  // namespace dg
