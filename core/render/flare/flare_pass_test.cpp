// Ghosts traced from the emitters, compared with rays traced backward from the film through the same surfaces, which
// look up the emission where they leave the lens and need no aiming or learning.
#include "render/flare/flare_pass.h"

#include <doctest/doctest.h>

#include "render/flare/flare_probe.h"
#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

/// A dark sky with a bright window of some tens of degrees in front of the camera.
EnvironmentImage window_sky() {
    EnvironmentImage sky{32, 16, std::vector<Rgb>(32 * 16, Rgb{0.2f, 0.3f, 0.5f})};
    for (int r = 4; r < 7; ++r)
        for (int c = 15; c < 18; ++c) sky.pixels[std::size_t(r) * 32 + c] = {60, 50, 40};
    return sky;
}

/// A sky, a lamp, an emissive ball, and a black occluder of some of their light.
std::shared_ptr<const Scene> bright_scene() {
    SceneDescription d;
    d.environment = Environment::image(window_sky(), 1, {});
    d.meshes = {quad_mesh()};
    const Material black{"black", DiffuseMaterial{{0, 0, 0}}};
    const Material lamp{"lamp", DiffuseMaterial{{0, 0, 0}}, Rgb{30, 40, 50}, true};
    d.materials = {black, lamp};
    const auto at = [](Vec3f p, float scale) { return placed(p, scale); };
    d.instances = {{"hides", 0, 0, at({0.03f, 0.02f, -0.5f}, 0.03f)}, {"lamp", 0, 1, at({-0.3f, -0.1f, -0.9f}, 0.1f)}};
    d.lights = {SphereLight{{{0.25f, -0.1f, -1.1f}, 0.08f}, {50, 30, 20}}};
    return Scene::build(std::move(d));
}

/// Share of the ghosts' light that enters outside the learned cells.
double share_outside(const Scene& scene, const Camera& camera) {
    const FlareAim aim(scene, camera, settings(1, 100));
    const FlareKnowledge known = learn_flare(aim, 2);
    double all = 0, outside = 0;
    for (int g = 0; g < aim.ghosts(); ++g) {
        const FlareCells& cells = known.cells[std::size_t(known.cells_of_pair[g])];
        if (cells.weights.empty()) continue;   // no light was found on the frame
        for (const FlareFound::Hit& hit : probe_flare(aim, {0, g, 1 << 15}).hits)
            all += hit.luminance, outside += cells.inner.holds(hit.at) ? 0 : hit.luminance;
    }
    REQUIRE(all > 0);
    return outside / all;
}

}  // namespace

TEST_CASE("ghosts from the emitters are those that rays from the film find") {
    static const char* more = std::getenv("DG_EFFORT");
    const int effort = more ? std::atoi(more) : 1;
    const auto scene = bright_scene();
    Prescription bare = test::tessar(), coated = test::sonnar(), wide = test::wide_angle();
    bare.coating = Coating::uncoated, wide.coating = Coating::broadband;
    const SensorStack body{.cover_thickness = 1.5, .cover_gap = 0.8, .reflectance = 0.15};
    const Camera cameras[] = {camera_with(bare), camera_with(coated, body), camera_with(wide)};
    for (const Camera& camera : cameras) {
        const Blocks light = forward(*scene, camera, 8, 40000.0 * effort);
        const Backward reference(*scene, camera);
        const Blocks film = reference.pictures(8, 100000 * effort);
        INFO(reference.ghosts.tracer().prescription().name << ": from the emitters " << show(light)
                                                             << ", from the film " << show(film));
        if (more)
            MESSAGE(reference.ghosts.tracer().prescription().name << show(light) << show(film)
                                                                  << equality(light, film));
        CHECK(whole(film).mean > 0);
        CHECK(equality(light, film) > 1e-3);
    }
}

TEST_CASE("what is drawn by what was learned is what is drawn by nothing") {
    const auto scene = bright_scene();
    Prescription lens = test::wide_angle();
    lens.coating = Coating::broadband;   // has the largest spectral variation
    const Camera camera = camera_with(lens);
    const Blocks learned = forward(*scene, camera, 8, 40000), plain = forward(*scene, camera, 8, 100000, false);
    INFO(show(learned) << show(plain));
    CHECK(equality(learned, plain) > 1e-3);
}

TEST_CASE("the part of the front that is drawn densely holds the light of ghosts") {
    double outside = 0;   // share, summed
    for (const Vec3f at : {Vec3f{100, 60, -1000}, Vec3f{20, 200, -1000}, Vec3f{-250, 100, -1000}}) {
        SceneDescription far;
        far.lights = {SphereLight{{at, 4.6f}, {1000, 1000, 1000}}};
        const auto scene = Scene::build(std::move(far));
        for (const Prescription& lens : {test::wide_angle(), test::telephoto(), test::fisheye()})
            outside += share_outside(*scene, camera_with(lens));
    }
    CHECK(outside < 0.02);   // 0.75 without the growth of rectangles with light at their edge
}

TEST_CASE("from a near light rays are as dense as solid angles of the square tell") {
    SceneDescription near;
    near.lights = {PointLight{Vec3f{0.01f, 0.02f, -0.04f}, {1, 1, 1}}};
    const auto scene = Scene::build(std::move(near));
    const Camera camera = camera_with(test::tessar());
    const FlareAim aim(*scene, camera, settings(1, 100));
    const FlareAim::Random u{0, 0.5f, {0, 0}, {.time = 0.5f}};
    const auto middle = aim.aim(0, 0, {0, 0}, 0.25, u);
    REQUIRE(middle);
    for (const Vec2f at : {Vec2f{0.5f, 0}, Vec2f{0.3f, -0.4f}, Vec2f{-0.6f, 0.1f}}) {
        const auto path = aim.aim(0, 0, at, 0.25, u);
        REQUIRE(path);
        // The square is perpendicular to the ray at its center. With d = h / cos, d^2 / cos converts 1/m2 to 1/sr.
        const double cosine = dot(path->lens.ray.direction, middle->lens.ray.direction);
        CHECK(cosine < 0.995);
        CHECK(path->density / middle->density == doctest::Approx(std::pow(cosine, -3)).epsilon(1e-5));
    }
}

TEST_CASE("what lands beside the frame counts as far as the filter reaches") {
    const auto scene = bright_scene();
    const Camera camera = camera_with(test::tessar());
    RenderSettings s = settings(1, 100);
    s.filter = Filter(FilterKind::gaussian, 2);
    const FlareAim aim(*scene, camera, s);
    const auto lands = [&](Vec2f px) {
        return aim.on_frame({.film_mm = s.sensor.mm_from_px(px), .transmittance = 0.1f}, 0.5f).has_value();
    };
    for (const float y : {-1.9f, kHeight + 1.9f}) CHECK(lands({3, y}));
    for (const float x : {-1.9f, kWidth + 1.9f}) CHECK(lands({x, 3}));
    for (const float y : {-2.1f, kHeight + 2.1f}) CHECK_FALSE(lands({3, y}));
    for (const float x : {-2.1f, kWidth + 2.1f}) CHECK_FALSE(lands({x, 3}));
    CHECK_FALSE(aim.on_frame({.film_mm = {0, 0}, .transmittance = 0}, 0.5f).has_value());
}

TEST_CASE("a lens that reflects nothing has no flare") {
    Prescription lens = test::tessar();
    lens.coating = Coating::perfect;
    const auto scene = bright_scene();
    Film film(FilmLayout{.width = kWidth, .height = kHeight, .layers = {Layer::flare}});
    const RenderCounters counters = draw_flare(*scene, camera_with(lens), film, settings(1, 1000));
    CHECK(counters.flare_paths == 0);
    for (const float v : film.means("flare")) CHECK(v == 0);
}

TEST_CASE("ghosts of lights without size are the limit of small lamps") {
    // A small ball and a point light of the same intensity; a far ball and a directional light.
    SceneDescription ball, point;
    const float radius = 0.01f;
    const Vec3f at{0.1f, 0.12f, -0.8f};
    ball.lights = {SphereLight{{at, radius}, Rgb{1, 1, 1} * (1000 / (kPi * radius * radius))}};
    point.lights = {PointLight{at, {1000, 1000, 1000}}};
    const Camera camera = camera_with(test::tessar());
    const auto a = Scene::build(std::move(ball)), b = Scene::build(std::move(point));
    const Blocks of_ball = forward(*a, camera, 8, 40000), of_point = forward(*b, camera, 8, 40000);
    INFO(show(of_ball) << show(of_point));
    CHECK(whole(of_point).mean / whole(of_ball).mean == doctest::Approx(1).epsilon(0.015));

    SceneDescription far, sun;
    const Vec3f way = normalize(Vec3f{0.08f, 0.1f, -1});
    far.lights = {SphereLight{{way * 1000.f, 2}, Rgb{1, 1, 1} * (1e5f / kPi)}};
    const float lux = 1e5f / kPi * kPi * 4 / 1e6f;
    sun.lights = {DirectionalLight{-way, {lux, lux, lux}}};
    const auto c = Scene::build(std::move(far)), d = Scene::build(std::move(sun));
    const Blocks of_far = forward(*c, camera, 8, 40000), of_sun = forward(*d, camera, 8, 40000);
    INFO(show(of_far) << show(of_sun));
    CHECK(whole(of_sun).mean / whole(of_far).mean == doctest::Approx(1).epsilon(0.015));
}

TEST_CASE("ghosts of a sun with an angle are those of a far ball that looks as large") {
    const Vec3f way = normalize(Vec3f{0.08f, 0.1f, -1});
    const Rgb lux{100, 100, 100};
    const Camera camera = camera_with(test::tessar());
    const auto ghosts = [&](const Light& light) {
        SceneDescription d;
        d.lights = {light};
        return forward(*Scene::build(std::move(d)), camera, 8, 40000);
    };
    const auto far = [&](float sine) {
        return ghosts(SphereLight{{way * 1000.f, 1000 * sine}, lux * (1 / (kPi * sine * sine))});
    };
    const auto sun = [&](float sine) { return ghosts(DirectionalLight{-way, lux, 2 * std::asin(sine)}); };
    const Blocks of_far = far(0.06f), of_sun = sun(0.06f);   // 6.9 degrees across
    INFO(show(of_far) << show(of_sun));
    CHECK(equality(of_sun, of_far) > 1e-3);
    CHECK(equality(ghosts(DirectionalLight{-way, lux}), of_far) < 1e-6);
    // 2.3 degrees: the sun is drawn from maps, with an error of about 0.4 %, as it is at infinity.
    CHECK(whole(sun(0.02f)).mean / whole(far(0.02f)).mean == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE("flare has the same bits on any number of threads, and ranges of samples add") {
    const auto scene = bright_scene();
    const Camera camera = camera_with(test::tessar());
    const auto drawn = [&](int threads, std::uint32_t begin, std::uint32_t end, Film& film) {
        RenderSettings s = settings(3, 20001.3);
        s.threads = threads, s.sample_begin = begin, s.sample_end = end;
        draw_flare(*scene, camera, film, s);
    };
    check_same_bits({.width = kWidth, .height = kHeight, .layers = {Layer::flare}}, drawn);
}

TEST_CASE("most rays of the sun's ghosts come to the film") {
    SceneDescription d;
    d.lights = {DirectionalLight{-normalize(Vec3f{0.08f, 0.1f, -1}), {1e5f, 1e5f, 1e5f}}};
    const auto scene = Scene::build(std::move(d));
    Film film(FilmLayout{.width = kWidth, .height = kHeight, .layers = {Layer::flare}});
    RenderSettings s = settings(1, 200000);
    s.flare.maps = false;
    const RenderCounters c = draw_flare(*scene, camera_with(test::wide_angle()), film, s);
    INFO("share of rays on the film " << double(c.flare_hits) / double(c.flare_rays));
    CHECK(double(c.flare_hits) > 0.85 * double(c.flare_rays));
}
