// Ghosts of light that mirrors, glass and walls reflect to the lens.
#include "render/flare/highlight_survey.h"

#include <doctest/doctest.h>

#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

const Material kBlack{"black", DiffuseMaterial{{0, 0, 0}}};
const Material kMirror{"mirror", ConductorMaterial{{1, 1, 1}, 0}};

/// A quad [-width, width] x [-height, height] around a point, facing a direction.
Instance facing(std::uint32_t material, Vec3f at, Vec3f to, float width, float height) {
    const Vec3f z = normalize(to), x = normalize(cross(Vec3f{0, 1, 0}, z));
    return {"quad", 0, material, {x * width, cross(z, x) * height, z, at}};
}

/// A lamp far outside the frame, seen in a flat mirror, or the lamp at the position of its mirror image, without the
/// mirror. A screen occludes the direct light of the lamp.
std::shared_ptr<const Scene> mirrored(bool by_mirror) {
    const Vec3f lamp{0.35f, 0.1f, -0.3f}, image{-0.45f, 0.02f, -1}, way = lamp - image;
    const Vec3f at = image * (dot(way, (lamp + image) * 0.5f) / dot(way, image));
    SceneDescription d;
    d.meshes = {quad_mesh()};
    d.materials = {kBlack, kMirror};
    if (by_mirror)
        d.instances = {facing(1, at, way, 0.12f, 0.12f), facing(0, lamp * 0.5f, {1, 0, 0}, 0.08f, 0.08f)};
    d.lights = {SphereLight{{by_mirror ? lamp : image, 0.03f}, {400, 300, 200}}};
    return Scene::build(std::move(d));
}

/// A chrome ball and a glass ball under a lamp at the edge of the frame, a glossy table, a wall.
std::shared_ptr<const Scene> still_life() {
    SceneDescription d;
    d.meshes = {quad_mesh(), ball_mesh(3)};
    GltfMaterial table = plain(0.3f, {0.5f, 0.4f, 0.3f});
    d.materials = {kBlack, kMirror, {"table", table}, {"glass", DielectricMaterial{.ior = 1.5f, .dispersion = 0.5f}},
                   {"wall", DiffuseMaterial{{0.7f, 0.6f, 0.5f}}}};
    d.instances = {{"chrome", 1, 1, placed({-0.1f, 0, -0.7f}, 0.08f)},
                   {"glass", 1, 3, placed({0.12f, 0.02f, -0.8f}, 0.08f)},
                   facing(2, {0, -0.12f, -0.7f}, {0, 1, 0.01f}, 0.4f, 0.4f),
                   facing(4, {0, 0, -1.3f}, {0, 0, 1}, 0.6f, 0.6f)};
    d.lights = {SphereLight{{{0.1f, 0.35f, -0.8f}, 0.06f}, {300, 250, 200}}};
    return Scene::build(std::move(d));
}

}  // namespace

TEST_CASE("a mirror has the ghosts of the lamp that it shows") {
    Prescription lens = test::tessar();
    lens.coating = Coating::uncoated;
    const Camera camera = camera_with(lens);
    const auto mirror = mirrored(true), lamp = mirrored(false);
    const Blocks of_mirror = forward(*mirror, camera, 8, 40000), of_lamp = forward(*lamp, camera, 8, 40000);
    INFO(show(of_mirror) << show(of_lamp) << equality(of_mirror, of_lamp));
    CHECK(whole(of_mirror).mean > 0);
    CHECK(equality(of_mirror, of_lamp) > 1e-3);
}

TEST_CASE("ghosts of all light are those that paths from the film find") {
    static const char* more = std::getenv("DG_EFFORT");
    const int effort = more ? std::atoi(more) : 1;
    Prescription lens = test::tessar();
    lens.coating = Coating::uncoated;
    const Camera camera = camera_with(lens);
    const auto scene = still_life();
    const Blocks light = forward(*scene, camera, 8, 30000.0 * effort);
    Backward reference(*scene, camera);
    reference.reflected = true;
    const Blocks film = reference.pictures(8, 150000 * effort);
    INFO("forward " << show(light) << ", backward " << show(film) << equality(light, film));
    if (more) MESSAGE(show(light) << show(film) << equality(light, film));
    CHECK(equality(light, film) > 1e-3);
}

TEST_CASE("the sun on a chrome ball is found, though it is small") {
    Mesh ball = ball_mesh(4);
    ball.normals = ball.positions;
    SceneDescription d;
    d.meshes = {ball};
    d.materials = {kMirror};
    d.instances = {{"ball", 0, 0, placed({-0.1f, 0, -1.5f}, 0.15f)}};
    d.lights = {SphereLight{{{50, 80, 60}, 0.5f}, {1.6e9f, 1.6e9f, 1.6e9f}}};
    const auto scene = Scene::build(std::move(d));
    const FlareAim aim(*scene, camera_with(test::tessar()), settings(0, 1));
    INFO(aim.spots() << " spots by " << aim.survey_rays() << " rays");
    CHECK(aim.spots() == 1);
    CHECK(aim.survey_rays() < 200000);
}
