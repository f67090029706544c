// The denoiser's guides: albedo and normal behind glass and in mirrors.
#include <doctest/doctest.h>

#include <cmath>

#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

constexpr Rgb kWall{0.8f, 0.4f, 0.2f};
constexpr float kWays = 4000;

/// A square at z, facing +z, of side 2 s.
Mesh square(float z, float s, bool turned = false) {
    Mesh mesh;
    mesh.name = "square";
    const float x = turned ? -s : s;
    mesh.positions = {{-x, -s, z}, {x, -s, z}, {x, s, z}, {-x, s, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A wall at z = -5 behind the objects that `front` adds.
template <typename Front>
std::shared_ptr<const Scene> before_wall(Front front) {
    SceneDescription d;
    front(d);
    add(d, square(-5, 9), {"wall", DiffuseMaterial{kWall}});
    return Scene::build(std::move(d));
}

/// A pane of glass from z = -1 to -1.1.
void add_pane(SceneDescription& d, float roughness = 0, float dispersion = 0) {
    const Material glass{"glass", DielectricMaterial{1.5f, roughness, {1, 1, 1}, dispersion}};
    add(d, square(-1, 9), glass);
    add(d, square(-1.1f, 9, true), glass);
}

/// Mean guides over paths along -z.
FirstHit look(const Scene& scene, int splits, Vec3f direction = {0, 0, -1}) {
    FirstHit mean;
    PathSettings settings;
    settings.splits = splits;
    for (int i = 0; i < int(kWays); ++i) {
        PathSampler sampler(i, 0, 0, 7);
        const Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        Ray ray;
        ray.direction = direction;
        FirstHit hit;
        radiance(scene, ray, wavelengths, sampler, settings, &hit, nullptr);
        const Vec3f albedo = mean.guide_albedo, normal = mean.guide_normal;
        mean = hit;
        mean.guide_albedo = albedo + hit.guide_albedo * (1 / kWays);
        mean.guide_normal = normal + hit.guide_normal * (1 / kWays);
    }
    return mean;
}

/// Transmittance of a pane of glass with inter-reflections, n = 1.5, normal incidence.
constexpr float kFace = 0.04f, kThrough = (1 - kFace) / (1 + kFace);

}  // namespace

TEST_CASE("before a wall the guides are its own albedo and normal") {
    const auto scene = before_wall([](SceneDescription&) {});
    const FirstHit hit = look(*scene, 2);
    CHECK(hit.guide_albedo.x == doctest::Approx(kWall.x).epsilon(1e-3));
    CHECK(hit.guide_albedo.z == doctest::Approx(kWall.z).epsilon(1e-3));
    CHECK(hit.guide_normal.z == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("glass shows the wall behind it by the share of light that comes through, split or not") {
    for (const float dispersion : {0.f, 0.3f})
        for (const int splits : {0, 1, 2, 5}) {
            CAPTURE(splits);
            const auto scene = before_wall([&](SceneDescription& d) { add_pane(d, 0, dispersion); });
            const FirstHit hit = look(*scene, splits);
            CHECK(hit.position.z == doctest::Approx(-1));   // position remains the first surface's
            CHECK(hit.guide_albedo.x == doctest::Approx(kWall.x * kThrough).epsilon(0.01));
            CHECK(hit.guide_albedo.y == doctest::Approx(kWall.y * kThrough).epsilon(0.01));
            CHECK(hit.guide_normal.z == doctest::Approx(kThrough).epsilon(0.01));
            CHECK_FALSE(hit.guide_albedo.x == doctest::Approx(kWall.x).epsilon(0.01));
        }
}

TEST_CASE("a mirror shows what it reflects, of its own colour, and not what comes after") {
    // The mirror is tilted by 45 degrees: a ray along -z is reflected to the side wall.
    SceneDescription d;
    Mesh mirror = square(0, 1);
    mirror.positions = {{-1, -1, -1}, {1, -1, -3}, {1, 1, -3}, {-1, 1, -1}};
    add(d, mirror, {"mirror", ConductorMaterial{{1, 1, 1}, 0}});
    Mesh side = square(0, 9);
    side.positions = {{5, -9, -9}, {5, -9, 9}, {5, 9, 9}, {5, 9, -9}};
    add(d, side, {"side", DiffuseMaterial{kWall}});
    const auto scene = Scene::build(std::move(d));
    const FirstHit hit = look(*scene, 2);
    CHECK(hit.position.z == doctest::Approx(-2));
    CHECK(std::abs(hit.guide_normal.x) > 0.5f);
    CHECK(std::abs(hit.guide_normal.z) < 1e-3f);
    CHECK(hit.guide_albedo.x == doctest::Approx(kWall.x).epsilon(1e-3));
    CHECK(hit.guide_albedo.x / hit.guide_albedo.y == doctest::Approx(kWall.x / kWall.y).epsilon(1e-3));
}

TEST_CASE("frosted glass hides what is behind it, and nothing is 0") {
    const auto frosted = before_wall([](SceneDescription& d) { add_pane(d, 0.3f); });
    const FirstHit hit = look(*frosted, 2);
    CHECK(hit.guide_normal.z == doctest::Approx(1).epsilon(1e-3));
    const FirstHit sky = look(*before_wall([](SceneDescription& d) { add_pane(d); }), 2, {0, 0, 1});
    CHECK_FALSE(sky.found);
    CHECK(sky.guide_albedo == Vec3f{0, 0, 0});
}

}  // namespace dg
