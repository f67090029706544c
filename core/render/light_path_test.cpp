// Light paths with bounces: camera paths, light paths and both render the same picture, with every kind of light and
// camera.
#include "render/light_path_scenes.h"

using namespace dg;

TEST_CASE("camera, light and both: a table under a lamp of each kind, through a thin lens") {
    EnvironmentImage sky{16, 8, std::vector<Rgb>(128, Rgb{0.2f, 0.2f, 0.2f})};
    sky.pixels[16 * 1 + 5] = {60, 60, 60};
    std::vector<std::pair<const char*, World>> worlds;
    worlds.push_back({"sphere", World().light(kLamp)});
    worlds.push_back({"point", World().light(PointLight{{-0.2f, 0.5f, 0.1f}, {1, 1, 1}, 1.0f})});
    worlds.push_back({"spot", World().light(SpotLight{{-0.2f, 0.5f, 0.1f}, normalize(Vec3f{0.2f, -1, 0}), {1, 1, 1}, 0.3f, 0.8f})});
    worlds.push_back({"sun", World().light(DirectionalLight{normalize(Vec3f{0.3f, -1, 0.2f}), {2, 2, 2}})});
    worlds.push_back({"sun with an angle", World().add(1, {"ball", plain(0.4f)}, placed({0.1f, 0.12f, 0}, 0.12f))
        .light(DirectionalLight{normalize(Vec3f{0.3f, -1, 0.2f}), {2, 2, 2}, 2.2f})});
    worlds.push_back({"sky", World()});
    worlds.back().second.d.environment = Environment::image(sky, 1, {});
    worlds.push_back({"panel", World().add(0, {"panel", DiffuseMaterial{{0, 0, 0}}, {9, 9, 9}, true}, placed({0.1f, 0.5f, -0.2f}, 0.1f))});
    worlds.push_back({"all", World().light(kLamp).light(PointLight{{0.3f, 0.5f, 0.1f}, {0.2f, 0.2f, 0.2f}})
        .add(1, {"ball", plain(0.4f)}, placed({0.1f, 0.12f, 0}, 0.12f)).light(DirectionalLight{normalize(Vec3f{0.3f, -1, 0.2f}), {1, 1, 1}})});
    for (auto& [name, world] : worlds) {
        CAPTURE(std::string(name));
        check_one_picture(*world.scene(), thin());
    }
}

TEST_CASE("camera, light and both: through a pinhole, an exact lens, and a lens wide open") {
    const auto scene = World().add(1, {"ball", plain(0.4f)}, placed({0.1f, 0.12f, 0}, 0.12f))
                           .light(kLamp).light(PointLight{{0.3f, 0.5f, 0.1f}, {0.4f, 0.4f, 0.4f}}).scene();
    for (const Camera& camera : {camera_of(Pinhole{50}), exact(), camera_of(ThinLens{50, 60, 0.8})})
        check_one_picture(*scene, camera);
    Trial one_wavelength;
    one_wavelength.settings.dispersion = Dispersion::end_secondary;
    check_one_picture(*scene, exact(), one_wavelength);
    Trial wide_filter;   // has negative lobes and reaches beyond the frame
    wide_filter.filter = Filter(FilterKind::mitchell);
    check_one_picture(*scene, thin(), wide_filter);
}

TEST_CASE("camera, light and both: what moves, before a shutter that rolls") {
    World world;
    world.d.interval = {0, 1};
    const double times[] = {0, 1};
    Affine3d from, to;
    from.x = {0.12, 0, 0}, from.y = {0, 0.12, 0}, from.z = {0, 0, 0.12};
    to = from;
    from.origin = {-0.2, 0.13, 0}, to.origin = {0.2, 0.13, 0.1};
    world.add(1, {"ball", plain(0.4f)}, {});
    const Affine3d poses[] = {from, to};
    world.d.instances.back().motion =
        std::make_shared<const Motion>(Motion::keys(times, poses, Interpolation::decomposed));
    world.light(kLamp).light(PointLight{{0.3f, 0.5f, 0.1f}, {0.4f, 0.4f, 0.4f}});
    world.d.light_keys[0] = {{0, 1}, {kLamp, SphereLight{{{0.3f, 0.4f, 0.1f}, 0.05f}, {9, 30, 30}}}};
    world.add(0, {"panel", DiffuseMaterial{{0, 0, 0}}, {9, 9, 9}, true}, {});
    from.origin = {0.1, 0.5, -0.3}, to.origin = {-0.2, 0.4, -0.2};
    const Affine3d panel[] = {from, to};
    world.d.instances.back().motion =
        std::make_shared<const Motion>(Motion::keys(times, panel, Interpolation::decomposed));
    const auto scene = world.scene();
    for (const bool rolls : {false, true}) {
        ShutterSettings shutter;
        shutter.exposure_s = rolls ? 0.2 : 1;
        if (rolls) shutter.scan = ScanOrder::top, shutter.line_time_s = 0.8 / (kHeight - 1);
        Trial look;
        look.settings.shutter = Shutter(shutter, kWidth, kHeight);
        check_one_picture(*scene, thin(), look);
    }
}

TEST_CASE("camera, light and both: few bounces") {
    const auto scene = World().light(PointLight{{-0.2f, 0.3f, 0.1f}, {0.5f, 0.5f, 0.5f}}).scene();
    for (const int depth : {0, 1, 2}) {
        Trial look;
        look.settings.path.max_depth = depth;
        const Blocks by_both = draw(*scene, thin(), look, Technique::both);
        if (depth == 0) CHECK(whole(by_both).mean == 0);
        else check_one_picture(*scene, thin(), look);
    }
}

TEST_CASE("camera, light and both: light that all comes by way of a dark card behind the lens") {
    // Light from the card is dim enough for roulette, and nothing else lights the table. The test detects a density
    // error of 6 %, and roulette without compensation.
    Affine3f card;
    card.x = {-0.7f, 0, 0}, card.y = {0, 0.7f, 0}, card.z = {0, 0, -0.7f};
    card.origin = {0, 0.5f, 1.75f};
    const auto scene = World().add(0, {"card", plain(1, {0.2f, 0.2f, 0.2f})}, card)
                           .light(SpotLight{{0, 0.4f, 1.2f}, {0, 0, 1}, {9, 9, 9}, 0.6f, 0.9f}).scene();
    Trial look;
    look.m2 = 20000, look.camera_spp = 150;
    check_one_picture(*scene, thin(), look);
    const Blocks by_camera = draw(*scene, thin(), look, Technique::camera);
    CHECK(equality(by_camera, draw(*scene, thin(), look, Technique::light), 1.06) < 1e-3);
}
