// Ghosts of small sources from maps against exact paths: the map alone, and the map with corrections.
#include "render/flare/maps/sheet_pass.h"

#include <doctest/doctest.h>

#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

Blocks pictures(const Scene& scene, const Camera& camera, int count, double paths, bool maps,
                const Shutter& shutter = {}) {
    Blocks all;
    RenderSettings s = wide_settings(0, paths, maps);
    s.shutter = shutter;
    s.flare.guide = std::make_shared<const FlareGuide>(std::make_shared<const FlareAim>(scene, camera, s), s);
    CHECK(s.flare.guide->sheets().empty() == !maps);
    for (int k = 0; k < count; ++k) {
        s.seed = std::uint64_t(k) + 1;
        Film film(FilmLayout{.width = kWide, .height = kHigh, .layers = {Layer::flare}});
        draw_flare(scene, camera, film, s);
        all.push_back(blocks_of(film.means("flare")));
    }
    return all;
}

constexpr double kOpen_s = 0.02;

SphereLight sun_toward(float x) { return {{normalize(Vec3f{x, 0.08f, -1}) * 1000.f, 4.6f}, {3e5f, 3e5f, 3e5f}}; }

/// A sun that moves by four of its diameters while the shutter is open.
std::shared_ptr<const Scene> moving_sun() {
    SceneDescription d;
    d.lights = {sun_toward(0.1f)};
    d.interval = {0, kOpen_s};
    d.light_keys[0] = {{0, kOpen_s}, {sun_toward(0.1f), sun_toward(0.137f)}};
    return Scene::build(std::move(d));
}

/// The sun as a disc of `count` triangles that faces the lens.
std::shared_ptr<const Scene> sun_of_triangles(std::uint32_t count) {
    SceneDescription d;
    GltfMaterial shines;
    shines.emissive = {3e5f, 3e5f, 3e5f};
    d.materials = {{"shines", shines}};
    const SphereLight sun = sun_toward(0.12f);
    const Frame across = Frame::from_normal(normalize(sun.shape.center * -1.f));
    std::vector<Vec3f> positions{sun.shape.center};
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float angle = 2 * kPi * float(i) / float(count);
        const Vec3f rim{sun.shape.radius * std::cos(angle), sun.shape.radius * std::sin(angle), 0};
        positions.push_back(sun.shape.center + across.to_world(rim));
        triangles.push_back({0, i + 1, (i + 1) % count + 1});
    }
    Mesh mesh;
    mesh.positions = positions, mesh.triangles = triangles;
    d.meshes = {mesh};
    d.instances = {{"sun", 0, 0, Affine3f{}}};
    return Scene::build(std::move(d));
}

/// A black occluder in front of half of the front lens.
std::shared_ptr<const Scene> half_hidden_sun() {
    SceneDescription d;
    d.lights = {sun_toward(0.12f)};
    d.meshes = {quad_mesh()};
    d.materials = {{"black", DiffuseMaterial{{0, 0, 0}}}};
    d.instances = {{"hides", 0, 0, placed({0.065f, 0.016f, -0.2f}, 0.04f)}};
    return Scene::build(std::move(d));
}

/// Checks that maps and paths give the same X, Y and Z in every block.
void check_maps(const Scene& scene, const Shutter& shutter, double share_of_sunny_from, double to) {
    const Camera camera = camera_with(test::tessar());
    const Blocks maps = pictures(scene, camera, 6, 40000, true, shutter);
    const Blocks paths = pictures(scene, camera, 6, 800000, false, shutter);
    const double sunny_light = whole(pictures(*sunny(), camera, 1, 40000, true)).mean;
    INFO("from maps " << show(maps) << ", from paths " << show(paths) << ", of the sun alone " << sunny_light);
    CHECK(whole(paths).mean > share_of_sunny_from * sunny_light);
    CHECK(whole(paths).mean < to * sunny_light);
    CHECK(equality(maps, paths) > 1e-3);
}

}  // namespace

TEST_CASE("ghosts of the sun from maps are those from paths, in every channel and block") {
    const auto scene = sunny();
    for (const Prescription& lens : {test::tessar(), test::wide_angle(), test::telephoto()}) {
        const Camera camera = camera_with(lens);
        const Blocks maps = pictures(*scene, camera, 6, 40000, true), paths = pictures(*scene, camera, 6, 800000, false);
        INFO(lens.name << ": from maps " << show(maps) << ", from paths " << show(paths));
        CHECK(whole(paths).mean > 0);
        CHECK(equality(maps, paths) > 1e-3);
    }
}

TEST_CASE("a disc of triangles has the ghosts of a ball of its size, from maps") {
    const Camera camera = camera_with(test::tessar());
    const Blocks ball = pictures(*sunny(), camera, 6, 40000, true);
    for (const std::uint32_t triangles : {24u, 400u}) {
        const double share = 0.5 * triangles * std::sin(2 * kPiD / triangles) / kPiD;   // fraction of the circular disc's area
        Blocks disc = pictures(*sun_of_triangles(triangles), camera, 6, 40000, true);
        for (std::vector<double>& picture : disc)
            for (double& block : picture) block /= share;
        INFO(triangles << " triangles: " << show(disc) << ", a ball " << show(ball));
        CHECK(equality(disc, ball) > 1e-3);
    }
}

TEST_CASE("maps have the same bits on any number of threads, and ranges of samples add") {
    const auto scene = sunny();
    const Camera camera = camera_with(test::tessar());
    const auto drawn = [&](int threads, std::uint32_t begin, std::uint32_t end, Film& film) {
        RenderSettings s = wide_settings(3, 5001.3, true);
        s.threads = threads, s.sample_begin = begin, s.sample_end = end;
        draw_flare(*scene, camera, film, s);
    };
    check_same_bits({.width = kWide, .height = kHigh, .layers = {Layer::flare}}, drawn);
    check_crop(drawn);
}

TEST_CASE("what hides a part of the sun takes the same light of maps as of paths") {
    check_maps(*half_hidden_sun(), {}, 0.2, 0.8);
}

TEST_CASE("a leaf shutter opens over maps as over paths") {
    const Shutter leaf({.exposure_s = kOpen_s, .curve = OpeningCurve::trapezoid(0.6), .leaf = true}, kWide, kHigh);
    check_maps(*sunny(), leaf, 0.2, 0.9);
}

TEST_CASE("a sun that moves has the same ghosts from maps as from paths, also under a shutter that rolls") {
    const auto scene = moving_sun();
    check_maps(*scene, Shutter({.exposure_s = kOpen_s, .curve = {}}, kWide, kHigh), 0.8, 1.2);
    const ShutterSettings rolls{
        .exposure_s = kOpen_s / 4, .curve = {}, .scan = ScanOrder::top, .line_time_s = 0.75 * kOpen_s / kHigh};
    check_maps(*scene, Shutter(rolls, kWide, kHigh), 0.8, 1.2);
}
