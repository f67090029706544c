// Light paths with all kinds of materials: camera paths, light paths and both render the same picture.
#include "render/light_path_scenes.h"

using namespace dg;

namespace {

const SphereLight kLargeLamp{{{-0.35f, 0.6f, 0.1f}, 0.2f}, {6, 6, 6}};
const DielectricMaterial kGlass{1.5f, 0, {0.9f, 0.95f, 1}};

GltfMaterial solid(float roughness) {
    GltfMaterial m = plain(roughness, {0.9f, 0.9f, 0.8f});
    m.transmission = 0.9f;
    m.thickness = 0.1f;
    m.attenuation_distance = 0.1f;
    m.attenuation_color = {0.3f, 0.8f, 0.6f};
    return m;
}

GltfMaterial sheet() {
    GltfMaterial m = plain(0, {0.9f, 0.9f, 0.9f});
    m.transmission = 0.7f;   // 0.3 is diffuse, like dust
    return m;
}

Mesh smooth_ball() {
    Mesh m = ball_mesh(1);
    m.normals = std::vector<Vec3f>(m.positions.begin(), m.positions.end());
    return m;
}

Texture bumps() {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64; ++i) {
        const int a = (i * 37) % 7, b = (i * 53) % 5;
        texels.insert(texels.end(), {std::uint8_t(90 + 12 * a), std::uint8_t(100 + 14 * b), 215});
    }
    return {"bumps", 8, 8, 3, texels};
}

Material bumpy(float roughness) {
    GltfMaterial m = plain(roughness);
    m.metallic = 0.5f;
    m.normal_texture.index = 0;
    return {"bumpy", m};
}

const Affine3f kBallPlace = placed({0.05f, 0.13f, 0.05f}, 0.12f);
const Affine3f kPane = placed({0, 0.1f, 0.5f}, 0.5f);   // between camera and table

}  // namespace

TEST_CASE("camera, light and both: a table with things of all materials on it") {
    std::vector<std::pair<const char*, World>> worlds;
    const auto world = [&](const char* name, World w) { worlds.emplace_back(name, std::move(w)); };
    world("glossy", World({"table", plain(0.35f)}).light(kLamp));
    world("point in the corner", World()
                        .light(PointLight{{-0.2f, 0.3f, 0.1f}, {0.5f, 0.5f, 0.5f}}));
    world("mirror", World().add(0, {"mirror", ConductorMaterial{{0.9f, 0.9f, 0.9f}, 0}}, placed({0, 0.3f, -0.2f}, 0.3f)).light(kLargeLamp));
    world("glass ball", World().add(1, {"glass", kGlass}, kBallPlace).light(kLargeLamp));
    world("absorbing ball", World().add(1, {"glass", solid(0)}, kBallPlace).light(kLargeLamp));
    world("frosted ball", World().add(1, {"glass", solid(0.5f)}, kBallPlace).light(kLargeLamp));
    world("dispersive ball", World().add(1, {"glass", DielectricMaterial{1.5f, 0, {1, 1, 1}, 2}}, kBallPlace).light(kLargeLamp));
    world("dispersive frosted ball", World().add(1, {"glass", DielectricMaterial{1.5f, 0.2f, {1, 1, 1}, 2}}, kBallPlace).light(kLargeLamp));
    world("window", World().add(0, {"pane", sheet()}, kPane).light(kLamp));
    world("window, sun and point", World().add(0, {"pane", sheet()}, kPane).add(1, {"glass", solid(0)}, kBallPlace)
                                       .light(DirectionalLight{normalize(Vec3f{0.3f, -1, -0.4f}), {1, 1, 1}})
                                       .light(PointLight{{-0.2f, 0.5f, 0.7f}, {0.5f, 0.5f, 0.5f}}));
    world("window, sun with an angle", World().add(0, {"pane", sheet()}, kPane).add(1, {"glass", solid(0)}, kBallPlace)
                                           .light(DirectionalLight{normalize(Vec3f{0.3f, -1, -0.4f}), {1, 1, 1}, 0.4f}));
    World bumps_world(bumpy(0.4f));
    bumps_world.d.textures.push_back(bumps());
    world("bumpy", std::move(bumps_world.light(kLamp)));
    World smooth;
    smooth.d.meshes[1] = smooth_ball();
    world("smooth ball", std::move(smooth.add(1, {"ball", plain(0.5f)}, placed({0.05f, 0.2f, 0.05f}, 0.2f)).light(kLamp)));
    World smooth_glass;
    smooth_glass.d.meshes[1] = smooth_ball();
    world("smooth glass ball", std::move(smooth_glass.add(1, {"ball", kGlass}, kBallPlace).light(kLargeLamp)));
    GltfMaterial layered = plain(0.4f);
    layered.clearcoat.factor = 0.8f;
    layered.clearcoat.roughness = 0.3f;
    layered.sheen.color = {0.6f, 0.3f, 0.3f};
    layered.sheen.roughness = 0.5f;
    world("layered", World({"table", layered}).light(kLamp));
    GltfMaterial leaf = plain(0.6f, {0.4f, 0.7f, 0.3f});
    leaf.diffuse_transmission = 0.5f;
    world("leaf", World({"leaf", leaf}).add(0, {"leaf", leaf}, placed({0, 0.3f, 0}, 0.15f, true))
                      .light(SphereLight{{{0, 0.6f, 0}, 0.08f}, {20, 20, 20}}));
    DiffuseMaterial paper{{0.3f, 0.4f, 0.3f}, {}, {0.6f, 0.5f, 0.4f}};
    world("paper", World().add(0, {"paper", paper}, placed({0, 0.3f, 0}, 0.15f, true)).light(kLamp));
    CoatedMaterial plastic;
    plastic.diffuse.reflectance = {0.8f, 0.5f, 0.3f};
    world("smooth plastic", World({"table", plastic}).light(kLamp));
    plastic.alpha = 0.3f;
    world("rough plastic", World({"table", plastic}).light(kLamp));
    ConductorMaterial copper{{1, 1, 1}, {0.2f, 0.5f}};
    copper.fresnel = true;
    copper.eta = {0.3f, 0.9f, 1.2f}, copper.k = {3.3f, 2.6f, 2.4f};
    world("brushed copper", World({"table", copper}).light(kLamp));
    CoatedMaterial lacquer;
    lacquer.metal = true, lacquer.conductor = copper, lacquer.alpha = 0.2f;
    lacquer.thickness = 1e-4f, lacquer.absorption = {500, 2000, 4000};
    world("lacquer on copper", World({"table", lacquer}).light(kLamp));
    DielectricMaterial even = kGlass;
    even.alpha = {0.3f, 0.6f}, even.energy_compensation = true;
    world("even frosted ball", World().add(1, {"glass", even}, kBallPlace).light(kLargeLamp));
    DielectricMaterial pane = kGlass;
    pane.thin = true;
    world("pane", World().add(0, {"pane", pane}, kPane).light(kLamp));
    pane.alpha = 0.3f;
    world("frosted pane", World().add(0, {"pane", pane}, kPane).light(kLamp));
    Material one_sided{"one-sided", plain()};
    one_sided.two_sided = false;
    one_sided.kind = paper;
    world("one-sided", World().add(0, one_sided, placed({0, 0.3f, 0}, 0.15f, true)).light(kLamp));
    world("boundary",
          World().add(1, {"boundary", BoundaryMaterial{}}, placed({0.05f, 0.2f, 0.3f}, 0.3f)).light(kLamp));
    Material mask{"mask", copper};
    mask.opacity = 0.4f;
    world("mask", World().add(1, mask, kBallPlace).light(kLamp));
    // Mixtures on the table and on a ball, so that several vertices of a path choose.
    World mixed({"table", plain()});
    mixed.d.materials.push_back({"mirror", ConductorMaterial{{0.9f, 0.9f, 0.9f}, 0}});
    mixed.d.materials.push_back({"glass", kGlass});
    mixed.d.materials.push_back({"mix", MixMaterial{0, 2, 0.4f}});
    mixed.d.materials.push_back({"mixture", MixMaterial{4, 3, 0.3f}});
    mixed.d.instances[0].material = 4;
    world("mixtures", std::move(mixed.add(1, {"ball", MixMaterial{0, 5, 0.8f}}, kBallPlace).light(kLargeLamp)));
    world("lamp in glass", World().add(1, {"glass", solid(0)}, kBallPlace)
                               .light(SphereLight{{{0.05f, 0.13f, 0.05f}, 0.05f}, {20, 20, 20}}));
    world("glass in glass", World().add(1, {"glass", solid(0)}, kBallPlace)
                                .add(1, {"inner", kGlass}, placed({0.05f, 0.13f, 0.05f}, 0.06f)).light(kLargeLamp));
    world("glass before the lens", World().add(1, {"glass", kGlass}, placed({0.08f, 0.4f, 0.85f}, 0.1f)).light(kLargeLamp));
    for (auto& [name, w] : worlds) {
        CAPTURE(std::string(name));
        check_one_picture(*w.scene(), thin());
    }
}
