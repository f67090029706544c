// Light that changes while the shutter is open: all strategies have the same mean, which is the mean of the pictures
// of static scenes at single times.
#include <doctest/doctest.h>

#include "math/hash.h"
#include "math/statistics.h"
#include "transport/path.h"

namespace dg {
namespace {

using Strategy = PathSettings::Strategy;
constexpr double kOpen = 10, kClose = 10.5;  // s
constexpr int kTimes = 32;

Mesh quad(float half) {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// Scene of a floor at y = 0 with reflectance 0.5, for tests to extend.
SceneDescription floor_scene() {
    SceneDescription d;
    d.meshes = {quad(20)};
    d.materials = {{"floor", DiffuseMaterial{{0.5f, 0.5f, 0.5f}}}};
    d.instances = {{"floor", 0, 0, {}}};
    d.interval = {kOpen, kClose};
    return d;
}

Affine3d turned(double degrees, Vec3d origin) {
    Affine3d m = to_matrix(Quaterniond::from_axis_angle(normalize(Vec3d{1, 0, 0.3}), degrees * kPiD / 180));
    m.origin = origin;
    return m;
}

void add_lamp(SceneDescription& d, Rgb luminance, bool two_sided) {
    d.meshes.push_back(quad(0.5f));
    d.materials.push_back({"lamp", DiffuseMaterial{{0, 0, 0}}, luminance, two_sided});
    d.instances.push_back({"lamp", 1, 1, to_float(turned(180, {0.5, 1, 0}))});
}

Motion between(const Affine3d& a, const Affine3d& b) {
    return Motion::keys(std::array{kOpen, kClose}, std::array{a, b}, Interpolation::decomposed);
}

/// The static scene at a time (fraction of the interval).
SceneDescription still(SceneDescription d, float fraction) {
    const double t = kOpen + double(fraction) * (kClose - kOpen);
    for (Instance& i : d.instances) {
        if (i.motion) i.world_from_local = to_float(i.motion->at(t));
        if (i.shown && !i.shown->at(t)) i.world_from_local.origin.y = 1e6f;
        i.motion = nullptr;
        i.shown = nullptr;
    }
    for (const auto& [i, keys] : d.material_keys) d.materials[i] = keys.at(t);
    for (const auto& [i, keys] : d.light_keys) d.lights[i] = keys.at(t);
    if (d.environment_keys) d.environment = d.environment->posed({{0}, {d.environment_keys->at(t)}});
    for (Mesh& mesh : d.meshes) {
        if (mesh.steps == 1) continue;
        const std::size_t n = mesh.positions.size() / mesh.steps;
        const double x = double(fraction) * (mesh.steps - 1);
        const std::size_t k = std::min(std::size_t(x), std::size_t(mesh.steps) - 2);
        std::vector<Vec3f> now;
        for (std::size_t i = 0; i < n; ++i)
            now.push_back(mesh.positions[k * n + i] * float(1 - (x - double(k))) +
                          mesh.positions[(k + 1) * n + i] * float(x - double(k)));
        mesh.positions = now;
        mesh.steps = 1;
    }
    d.material_keys.clear();
    d.light_keys.clear();
    d.environment_keys.reset();
    return d;
}

/// Luminances of n paths to the floor near the origin at one of kTimes times.
void look(const Scene& scene, Strategy strategy, int time, int n, std::vector<double>& values) {
    PathSettings settings;
    settings.strategy = strategy;
    settings.max_depth = 2;
    for (int i = 0; i < n; ++i) {
        PathSampler sampler(i % 64, time, std::uint32_t(i / 64), 7);
        Wavelengths wl = Wavelengths::sample(0.4f);
        Ray ray;
        ray.origin = {0.2f, 0.3f, 0.1f};
        ray.direction = normalize(Vec3f{0.2f * float(hash_uniform(1, i)), 0, 0} - ray.origin);
        ray.time = (float(time) + 0.5f) / kTimes;
        const Spectrum l = radiance(scene, ray, wl, sampler, settings, nullptr, nullptr).sum();
        values.push_back(l[0] / wl.emission({1, 1, 1})[0]);
    }
}

SampleMoments moving(const SceneDescription& d, Strategy strategy, int n) {
    const auto scene = Scene::build(d);
    std::vector<double> values;
    for (int t = 0; t < kTimes; ++t) look(*scene, strategy, t, n / kTimes, values);
    return moments(values);
}

SampleMoments mean_of_stills(const SceneDescription& d, int n) {
    std::vector<double> values;
    for (int t = 0; t < kTimes; ++t)
        look(*Scene::build(still(d, (float(t) + 0.5f) / kTimes)), Strategy::mis, t, n / kTimes, values);
    return moments(values);
}

void check_all(const SceneDescription& d, int n = 40000) {
    const SampleMoments expected = mean_of_stills(d, n);
    CHECK(expected.mean > 0.01);
    CHECK(std::sqrt(expected.variance / expected.count) < 0.02 * expected.mean);
    CHECK(welch_p_value(expected, moving(d, Strategy::mis, n)) > 1e-4);
    CHECK(welch_p_value(expected, moving(d, Strategy::bsdf, 4 * n)) > 1e-4);
    CHECK(welch_p_value(expected, moving(d, Strategy::light, n)) > 1e-4);
}

}  // namespace

TEST_CASE("an area light that travels and turns by 170 degrees") {
    SceneDescription d = floor_scene();
    add_lamp(d, {9, 9, 9}, true);
    d.instances[1].motion = std::make_shared<const Motion>(
        between(turned(0, {-1.5, 0.8, 0.3}), turned(170, {1.5, 1.2, -0.3})));
    check_all(d);
}

TEST_CASE("an area light that spins, and shines to one side") {
    for (const double turns : {0.7, 3.0, 60.0}) {  // for 60 turns, the bounds are those of a whole turn
        SceneDescription d = floor_scene();
        add_lamp(d, {9, 9, 9}, false);
        Spin spin;
        spin.axis = {0, 0, 1};
        spin.revolutions_per_second = turns / (kClose - kOpen);
        spin.center = {0.4, 0, 0};
        d.instances[1].motion =
            std::make_shared<const Motion>(Motion(turned(20, {0.3, 1, 0})).spinning(spin));
        check_all(d);
        // The means would differ if light sampling missed the emitter at some times.
        const auto scene = Scene::build(d);
        const Wavelengths wl = Wavelengths::sample(0.4f);
        int found = 0;
        for (int i = 0; i < 1000; ++i)
            found += scene->lights().sample(0.5f, {0.3f, 0.4f}, {}, (float(i) + 0.5f) / 1000, wl).has_value();
        CHECK(found > 300);
    }
}

TEST_CASE("an area light that deforms, grows out of nothing, and is there for a time") {
    SceneDescription d = floor_scene();
    add_lamp(d, {9, 9, 9}, true);
    std::vector<Vec3f> steps;
    for (const float y : {0.f, 0.4f, -0.2f})
        for (Vec3f p : d.meshes[1].positions) {
            p.y = y * p.x;
            steps.push_back(p * (y == 0 ? 0.f : 1.f));
        }
    d.meshes[1].positions = steps;
    d.meshes[1].steps = 3;
    check_all(d);
    d.instances[1].shown = std::make_shared<const Shown>(Shown{{{10.1, 10.2}, {10.3, 11}}});
    check_all(d);
}

TEST_CASE("an area light that is pressed flat is met by no ray, and lights nothing") {
    SceneDescription d = floor_scene();
    add_lamp(d, {9, 9, 9}, true);
    Affine3d whole = turned(0, {0.5, 1, 0}), flat = whole;
    flat.y = {};  // a flat lamp keeps its area
    d.instances[1].motion = std::make_shared<const Motion>(
        Motion::keys(std::array{kOpen, 10.2, kClose}, std::array{whole, flat, flat}, Interpolation::linear));
    const SampleMoments bsdf = moving(d, Strategy::bsdf, 160000);
    CHECK(bsdf.mean > 0.1);
    CHECK(welch_p_value(bsdf, moving(d, Strategy::light, 40000)) > 1e-4);
    CHECK(welch_p_value(bsdf, moving(d, Strategy::mis, 40000)) > 1e-4);
}

TEST_CASE("an area light that dims, is switched off, and on again in another colour") {
    SceneDescription d = floor_scene();
    add_lamp(d, {0, 0, 0}, true);
    Material off = d.materials[1], bright = off, red = off;
    bright.emission = {20, 20, 20};
    red.emission = {9, 1, 1};
    d.material_keys[1] = {{10, 10.1, 10.2, 10.35, 10.35, 12}, {off, bright, off, off, red, red}};
    CHECK(Scene::build(d)->lights().lights().size() == 2);
    check_all(d);
}

TEST_CASE("a glTF lamp whose veil, texture transform and strength change") {
    SceneDescription d = floor_scene();
    add_lamp(d, {0, 0, 0}, true);
    d.meshes[1].uv[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    d.textures.push_back({"stripe", 4, 1, 3, std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255}});
    GltfMaterial a;
    a.base_color = {0, 0, 0};
    a.double_sided = true;
    a.alpha_mode = GltfMaterial::AlphaMode::blend;
    a.base_alpha = 0.1f;
    a.emissive = {40, 40, 40};
    a.emissive_texture.index = 0;
    GltfMaterial b = a;
    b.base_alpha = 1;
    b.emissive = {20, 30, 40};
    b.emissive_texture.m[2] = 2;  // translated by twice its width
    d.material_keys[1] = {{kOpen, kClose}, {{"lamp", a}, {"lamp", b}}};
    CHECK(Scene::build(d)->lights().lights().size() == 2);  // a triangle that is dark at first is a light, too
    check_all(d, 80000);
}

TEST_CASE("a sphere light that flies by, grows and dims; a spot that sweeps; a sun that sets") {
    SceneDescription d = floor_scene();
    const Rgb white{9, 9, 9};
    d.lights.push_back(SphereLight{{{-2, 0.9f, 0}, 0.1f}, white});
    d.light_keys[0] = {{10, 10.3, 10.6},
                       {SphereLight{{{-2, 0.9f, 0}, 0.3f}, white}, SphereLight{{{0.5f, 0.8f, 0}, 0.5f}, white},
                        SphereLight{{{2, 3, 0}, 0.1f}, Rgb{1, 1, 1}}}};
    check_all(d);
    d.lights.push_back(SpotLight{{0, 2, 0}, {1, 0, 0}, {3, 3, 3}, 0.1f, 0.5f});
    d.light_keys[1] = {{10, 10.5},
                       {SpotLight{{0, 2, 0}, {1, 0, 0}, {3, 3, 3}, 0.1f, 0.5f},
                        SpotLight{{0, 2, 0}, normalize(Vec3f{-1, -1, 0}), {5, 5, 5}, 0.2f, 0.4f}}};
    d.lights.push_back(DirectionalLight{{0, -1, 0}, {1, 1, 1}});
    d.light_keys[2] = {{10, 10.4},
                       {DirectionalLight{{0, -1, 0}, {1, 1, 1}}, DirectionalLight{{1, 0, 0}, {0, 0, 0}}}};
    const SampleMoments expected = mean_of_stills(d, 20000);
    CHECK(welch_p_value(expected, moving(d, Strategy::mis, 20000)) > 1e-4);
    CHECK(welch_p_value(expected, moving(d, Strategy::light, 20000)) > 1e-4);
}

TEST_CASE("a sky that turns and fades") {
    SceneDescription d = floor_scene();
    EnvironmentImage sky{16, 8, std::vector<Rgb>(128, Rgb{0.1f, 0.1f, 0.1f})};
    for (int i : {18, 19, 34, 35}) sky.pixels[i] = {40, 40, 40};
    d.environment = Environment::image(sky, 1, {});
    d.environment_keys = {{10, 10.25, 10.5}, {{{1, 1, 1}, 0}, {{2, 1, 0.5f}, 4}, {{0, 0, 0}, 3}}};
    // A wall occludes a part of the sky, so that the floor's luminance depends on the sky's rotation.
    d.meshes.push_back(quad(3));
    d.instances.push_back({"wall", 1, 0, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0}}});
    check_all(d);
}

TEST_CASE("a floor whose colour changes, a pane that clears, turns to a solid and frosts") {
    SceneDescription d = floor_scene();
    d.environment = Environment::constant({1, 1, 1});
    const Material dark{"floor", DiffuseMaterial{{0, 0.1f, 0.2f}}}, light{"floor", DiffuseMaterial{{1, 1, 0.8f}}};
    d.material_keys[0] = {{9, 11}, {dark, light}};
    check_all(d);
    add_lamp(d, {9, 9, 9}, true);
    GltfMaterial pane;
    pane.metallic = pane.roughness = 0;
    pane.transmission = 1;
    pane.base_color = {0.5f, 0.9f, 0.7f};
    GltfMaterial solid = pane, frosted = pane;
    solid.thickness = 0.05f;
    frosted.roughness = 0.5f;
    frosted.transmission = 0.4f;
    d.meshes.push_back(quad(4));
    d.materials.push_back({"pane", pane});
    Affine3f above;
    above.origin = {0, 0.7f, 0};
    d.instances.push_back({"pane", 2, 2, above});
    d.material_keys[2] = {{10, 10.2, 10.2, 10.35, 10.5},
                          {{"pane", pane}, {"pane", pane}, {"pane", solid}, {"pane", solid}, {"pane", frosted}}};
    const SampleMoments expected = mean_of_stills(d, 200000);
    CHECK(welch_p_value(expected, moving(d, Strategy::mis, 200000)) > 1e-4);
    CHECK(welch_p_value(expected, moving(d, Strategy::bsdf, 800000)) > 1e-4);
}

TEST_CASE("keys that cannot be used are refused with their place") {
    SceneDescription d = floor_scene();
    const Material floor = d.materials[0];
    d.material_keys[0] = {{1, 0.5}, {floor, floor}};
    CHECK_THROWS_WITH(Scene::build(d), doctest::Contains("material 'floor': key 1: time: wanted finite"));
    d.material_keys[0] = {{1}, {floor, floor}};
    CHECK_THROWS_WITH(Scene::build(d), doctest::Contains("one value for each time"));
    d.material_keys = {{5, {{1}, {floor}}}};
    CHECK_THROWS_WITH(Scene::build(d), doctest::Contains("keys of material 5"));
    d.material_keys.clear();
    d.lights.push_back(PointLight{});
    d.light_keys[0] = {{0, std::nan("")}, {PointLight{}, PointLight{}}};
    CHECK_THROWS_WITH(Scene::build(d), doctest::Contains("light 0: key 1: time"));
}

}  // namespace dg
