// Scattered light traced from the emitters, compared with random walks traced backward from the film through the lens,
// which look up the emission where they leave it and need no aiming or learning.
#include "render/flare/scatter_pass.h"

#include <doctest/doctest.h>

#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

/// A dark sky with a bright window to the left of the frame, a lamp inside the frame, and a black occluder.
std::shared_ptr<const Scene> bright_scene() {
    EnvironmentImage sky{32, 16, std::vector<Rgb>(32 * 16, Rgb{0.2f, 0.3f, 0.5f})};
    for (int r = 5; r < 9; ++r)
        for (int c = 13; c < 16; ++c) sky.pixels[std::size_t(r) * 32 + c] = {60, 50, 40};
    SceneDescription d;
    d.environment = Environment::image(sky, 1, {});
    d.meshes = {quad_mesh()};
    const Material black{"black", DiffuseMaterial{{0, 0, 0}}};
    const Material lamp{"lamp", DiffuseMaterial{{0, 0, 0}}, Rgb{30, 40, 50}, true};
    d.materials = {black, lamp};
    const auto at = [](Vec3f p, float scale) { return placed(p, scale); };
    d.instances = {{"hides", 0, 0, at({-0.1f, 0.02f, -0.3f}, 0.05f)}, {"lamp", 0, 1, at({0.3f, -0.1f, -0.9f}, 0.2f)}};
    return Scene::build(std::move(d));
}

Camera scattering(const Prescription& lens, const LensScatter& parts) {
    Camera camera = camera_with(lens);
    camera.scatter = parts;
    return camera;
}

RenderSettings scatter_settings(std::uint64_t seed, double paths, bool reflected = false) {
    RenderSettings s = settings(seed, 0);
    s.flare.highlights = reflected;
    s.scatter.per_sample = paths;
    return s;
}

Blocks from_emitters(const Scene& scene, const Camera& camera, int pictures, double paths, bool reflected = false) {
    Blocks all;
    RenderSettings s = scatter_settings(0, paths, reflected);
    const auto aim = std::make_shared<const FlareAim>(scene, camera, s);
    s.scatter.guide = std::make_shared<const ScatterGuide>(aim, scene, camera, s);
    for (int k = 0; k < pictures; ++k) {
        s.seed = std::uint64_t(k) + 1;
        Film film(FilmLayout{.width = kWidth, .height = kHeight, .layers = {Layer::flare}});
        render(scene, camera, film, s, nullptr);
        all.push_back(by_blocks(film.means("flare")));
    }
    return all;
}

/// Walks from film points toward a disc at the last vertex, which is wider than the glass as in flare_scenes.h.
Blocks from_film(const Scene& scene, const Camera& camera, int pictures, int walks) {
    const ExactLens& lens = std::get<ExactLens>(camera.lens);
    const ScatterLens parts = lens.scatter(camera.sensor_stack, camera.scatter);
    const Prescription& own = lens.tracer().prescription();
    const double rear = own.last_vertex(), radius = clear_radius(own.surfaces.back()) + 3;
    const Vec3d pupil{0, 0, lens.first_order().entrance_pupil_z};
    Blocks all;
    for (int picture = 0; picture < pictures; ++picture) {
        std::mt19937_64 rng(std::uint64_t(picture) + 77);
        std::uniform_real_distribution<double> u(0, 1);
        std::vector<double> blocks(kBlockCount);
        for (int i = 0; i < walks; ++i) {
            const double px = u(rng), py = u(rng);   // fraction of the frame, from the top left
            const Wavelengths wl = Wavelengths::sample(float(u(rng)));
            const Vec2d disc = concentric_disc({u(rng), u(rng)}) * radius;
            const int k = int(u(rng) * kWavelengths);
            // The picture is upside down on the film.
            const Vec3d film{-(px - 0.5) * kSensorWidth, -(0.5 - py) * kSensorHeight, parts.ghosts().film().center.z};
            const Vec3d way = Vec3d{disc.x, disc.y, rear} - film;
            LensRay left;
            const auto light = parts.walk({film, normalize(way)}, parts.at(wl.nm[k]), 1, rng(), {.toward_film = false},
                                          nullptr, &left);
            if (!light) continue;
            const Ray out{.origin = to_float(1e-3 * (left.origin - pupil)), .direction = to_float(left.direction)};
            Spectrum value{0.f};
            value.set(k, float(kWavelengths * std::pow(-way.z / length(way), 4) / (way.z * way.z) * kPiD * radius *
                               radius * light->weight / lens.h0()));
            blocks[std::size_t(int(py * kHeight) / kBlock) * kBlockColumns + std::size_t(int(px * kWidth) / kBlock)] +=
                wl.to_xyz(wl.emission(light_along(scene, out)) * value).y * kBlockCount / walks;
        }
        all.push_back(blocks);
    }
    return all;
}

const Finish kGrey{.diffuse = 0.3, .gloss = 0.02}, kBlack{.diffuse = 0, .gloss = 0};

}  // namespace

TEST_CASE("light that the lens's parts scatter is the same from the emitters and from the film") {
    static const char* more = std::getenv("DG_EFFORT");
    const int effort = more ? std::atoi(more) : 1;
    const auto scene = bright_scene();
    // Parts with so much scattering that the test detects errors of a few percent.
    const Finish white{.diffuse = 0.9, .gloss = 0};
    const Camera cameras[] = {scattering(test::check_lens(false, 0.5), {white, kBlack, 0}),
                              scattering(test::tessar(), {kBlack, kBlack, 40, {0.1, -3}}),
                              scattering(test::sonnar(), {kGrey, kGrey, 40, {0.3, -3}})};
    for (const Camera& camera : cameras) {
        const Blocks light = from_emitters(*scene, camera, 16, 2500.0 * effort);
        const Blocks film = from_film(*scene, camera, 16, 5000 * effort);
        INFO("from the emitters " << show(light) << ", from the film " << show(film));
        if (more) MESSAGE(show(light) << show(film) << equality(light, film));
        CHECK(whole(film).mean > 0);
        CHECK(equality(light, film) > 1e-3);
        CHECK(welch_p_value(whole(light), whole(film)) > 1e-3);
    }
}

TEST_CASE("what a white wall sends to the lens is scattered as if the wall shone") {
    // Lit at normal incidence by pi lux, a white wall has a luminance of 1 cd/m2, like the emissive wall.
    SceneDescription white, shines;
    for (SceneDescription* d : {&white, &shines}) {
        d->meshes = {quad_mesh()};
        d->instances = {{"wall", 0, 0, placed({0.3f, 0, -0.6f}, 0.2f)}};
    }
    white.materials = {{"white", DiffuseMaterial{{1, 1, 1}}}};
    white.lights = {DirectionalLight{{0, 0, -1}, Rgb{kPi, kPi, kPi}}};
    shines.materials = {{"lamp", DiffuseMaterial{{0, 0, 0}}, Rgb{1, 1, 1}, true}};
    const Camera camera = scattering(test::tessar(), {kGrey, kGrey, 20, {0.1, -2}});
    const auto a = Scene::build(std::move(white)), b = Scene::build(std::move(shines));
    const Blocks reflects = from_emitters(*a, camera, 8, 4000, true), emits = from_emitters(*b, camera, 8, 4000);
    INFO(show(reflects) << show(emits));
    CHECK(whole(emits).mean > 0);
    CHECK(welch_p_value(whole(reflects), whole(emits)) > 1e-3);
}

TEST_CASE("a lens whose parts are black and smooth scatters nothing") {
    const auto scene = bright_scene();
    Film film(FilmLayout{.width = kWidth, .height = kHeight, .layers = {Layer::flare}});
    const RenderCounters c =
        render(*scene, scattering(test::tessar(), {kBlack, kBlack, 0}), film, scatter_settings(1, 1000), nullptr);
    CHECK(c.scatter_paths == 0);
    for (const float v : film.means("flare")) CHECK(v == 0);
}

TEST_CASE("scattered light of a light without size is the limit of that of a small lamp") {
    SceneDescription ball, point;
    const float radius = 0.01f;
    const Vec3f at{0.5f, 0.12f, -0.8f};   // outside the frame
    ball.lights = {SphereLight{{at, radius}, Rgb{1, 1, 1} * (1000 / (kPi * radius * radius))}};
    point.lights = {PointLight{at, {1000, 1000, 1000}}};
    const Camera camera = scattering(test::tessar(), {kGrey, kGrey, 20, {0.1, -2}});
    const auto a = Scene::build(std::move(ball)), b = Scene::build(std::move(point));
    const Blocks of_ball = from_emitters(*a, camera, 8, 6000), of_point = from_emitters(*b, camera, 8, 6000);
    INFO(show(of_ball) << show(of_point));
    CHECK(whole(of_ball).mean > 0);
    CHECK(equality(of_ball, of_point) > 1e-3);
    const SampleMoments m = whole(of_ball);
    CHECK(std::sqrt(m.variance / m.count) < 0.15 * m.mean);
}

TEST_CASE("scatter has the same bits on any number of threads, and ranges of samples add") {
    const auto scene = bright_scene();
    const Camera camera = scattering(test::tessar(), {});
    const auto drawn = [&](int threads, std::uint32_t begin, std::uint32_t end, Film& film) {
        RenderSettings s = scatter_settings(3, 1001.3);
        s.threads = threads, s.sample_begin = begin, s.sample_end = end;
        render(*scene, camera, film, s, nullptr);
    };
    check_same_bits({.width = kWidth, .height = kHeight, .layers = {Layer::flare}}, drawn);
}
