// Ghosts drawn from the emitters are those that rays find which leave the film, go the same ways backward, and
// look what shines where they come out: nothing is aimed or learned there.
#include "render/flare_pass.h"

#include <doctest/doctest.h>

#include <random>

#include "render/light_path_scenes.h"

using namespace dg;

namespace {

constexpr double kSensorWidth = 24, kSensorHeight = 18;   // mm
constexpr int kColumns = kWidth / kBlock, kBlocks = kColumns * (kHeight / kBlock);

/// A dark sky with a bright window of some tens of degrees before the camera.
EnvironmentImage window_sky() {
    EnvironmentImage sky{32, 16, std::vector<Rgb>(32 * 16, Rgb{0.2f, 0.3f, 0.5f})};
    for (int r = 4; r < 7; ++r)
        for (int c = 15; c < 18; ++c) sky.pixels[std::size_t(r) * 32 + c] = {60, 50, 40};
    return sky;
}

/// Sky, a lamp, a ball that shines, and something black in the way of some of their light.
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

Camera camera_with(const Prescription& lens, const SensorStack& stack = {}) {
    ExactLensSettings s;
    s.f_stop = 4;
    s.half_diagonal_mm = 16;
    s.iris = Iris::polygon(6, 10, 0);
    Camera camera{Motion(Affine3d{}), ExactLens(lens, s)};
    camera.sensor_stack = stack;
    return camera;
}

RenderSettings settings(std::uint64_t seed, double paths) {
    RenderSettings s;
    s.sensor = {kWidth, kHeight, kSensorWidth, kSensorHeight, {0, 0}};
    s.filter = Filter(FilterKind::box);
    s.seed = seed;
    s.flare.per_sample = paths;
    return s;
}

std::vector<double> by_blocks(const std::vector<float>& xyz) {
    std::vector<double> blocks(kBlocks);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            blocks[std::size_t(y / kBlock) * kColumns + x / kBlock] +=
                xyz[3 * (std::size_t(y) * kWidth + x) + 1] / (kBlock * kBlock);
    return blocks;
}

RenderCounters draw_flare(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& s) {
    return render(scene, camera, film, s, nullptr);
}

Blocks forward(const Scene& scene, const Camera& camera, int pictures, double paths) {
    Blocks all;
    RenderSettings s = settings(0, paths);
    s.flare.guide = std::make_shared<const FlareGuide>(scene, camera, s);
    for (int k = 0; k < pictures; ++k) {
        s.seed = std::uint64_t(k) + 1;
        Film film(FilmLayout{.width = kWidth, .height = kHeight, .flare = true});
        draw_flare(scene, camera, film, s);
        all.push_back(by_blocks(film.flare_xyz()));
    }
    return all;
}

/// What shines along a ray of the world.
Rgb light_along(const Scene& scene, const Ray& ray) {
    if (const auto hit = scene.intersect(ray)) {
        if (hit->sphere_light >= 0)
            return scene.lights().sphere_at(std::uint32_t(hit->sphere_light), ray.time).luminance;
        const SurfaceHit& s = hit->surface;
        const std::int64_t light = scene.lights().triangle_index(s.instance, s.primitive);
        if (light < 0) return {0, 0, 0};
        return scene.emission({.light = std::int32_t(light), .normal = s.ng}, s.wo, ray.time);
    }
    return scene.lights().environment()->luminance(ray.direction, ray.time);
}

/// Rays from film points toward points of a disc at the lens's last vertex, by a ghost, all evenly. The disc is
/// wider than the glass by what rays move before they meet it: it is curved, and the body has mirrors and plates.
struct Backward {
    const Scene& scene;
    const ExactLens& lens;
    GhostLens ghosts;
    std::vector<Mirrors> mirrors = ghosts.two_bounces();
    std::vector<LensPath> paths;
    double rear, radius;   // mm

    Backward(const Scene& s, const Camera& camera)
        : scene(s), lens(std::get<ExactLens>(camera.lens)), ghosts(lens.ghosts(camera.sensor_stack)) {
        for (const Mirrors& m : mirrors) paths.push_back(ghost_path(ghosts.passed(), m, false));
        const Prescription& own = lens.tracer().prescription();
        rear = own.last_vertex();
        radius = clear_radius(own.surfaces.back()) + 4.5;
    }

    std::vector<double> picture(int rays, std::uint64_t seed) const {
        std::mt19937_64 rng(seed);
        std::uniform_real_distribution<double> u(0, 1);
        std::vector<double> blocks(kBlocks);
        for (int i = 0; i < rays; ++i) {
            const double px = u(rng), py = u(rng);   // of the frame, from the top left
            const Wavelengths wl = Wavelengths::sample(float(u(rng)));
            const std::size_t which = std::size_t(u(rng) * double(paths.size()));
            const Vec2d disc = concentric_disc({u(rng), u(rng)}) * radius;
            const int k = int(u(rng) * kWavelengths);
            // The picture is upside down on the film.
            const Vec3d film{-(px - 0.5) * kSensorWidth, -(0.5 - py) * kSensorHeight, ghosts.film().center.z};
            const Vec3d way = Vec3d{disc.x, disc.y, rear} - film;
            TracedRay ray{{film, normalize(way)}};
            if (ghosts.tracer().follow(ray, paths[which], ghosts.tracer().at(wl.nm[k]), ghosts.clip()) >= 0)
                continue;
            if (!(ray.ray.direction.z < 0.999)) continue;
            const Vec3d pupil{0, 0, lens.first_order().entrance_pupil_z};
            Ray out{.origin = to_float(1e-3 * (ray.ray.origin - pupil)), .direction = to_float(ray.ray.direction)};
            const double cosine = -way.z / length(way);
            const double weight = std::pow(cosine, 4) / (way.z * way.z) * kPiD * radius * radius *
                                  ray.transmittance * double(paths.size()) / lens.h0();
            Spectrum value{0.f};
            value.set(k, float(kWavelengths * weight));
            const Spectrum light = wl.emission(light_along(scene, out)) * value;
            blocks[std::size_t(int(py * kHeight) / kBlock) * kColumns + std::size_t(int(px * kWidth) / kBlock)] +=
                wl.to_xyz(light).y * kBlocks / rays;
        }
        return blocks;
    }
    Blocks pictures(int count, int rays) const {
        Blocks all;
        for (int k = 0; k < count; ++k) all.push_back(picture(rays, std::uint64_t(k) + 77));
        return all;
    }
};

std::string show(const Blocks& b) {
    const SampleMoments m = whole(b);
    return std::to_string(m.mean) + " +- " + std::to_string(std::sqrt(m.variance / m.count)) + " ";
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

TEST_CASE("a lens that reflects nothing has no flare") {
    Prescription lens = test::tessar();
    lens.coating = Coating::perfect;
    const auto scene = bright_scene();
    Film film(FilmLayout{.width = kWidth, .height = kHeight, .flare = true});
    const RenderCounters counters = draw_flare(*scene, camera_with(lens), film, settings(1, 1000));
    CHECK(counters.flare_paths == 0);
    for (const float v : film.flare_xyz()) CHECK(v == 0);
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

TEST_CASE("flare has the same bits on any number of threads, and ranges of samples add") {
    const auto scene = bright_scene();
    const Camera camera = camera_with(test::tessar());
    const auto drawn = [&](int threads, std::uint32_t begin, std::uint32_t end, Film& film) {
        RenderSettings s = settings(3, 20001.3);
        s.threads = threads, s.sample_begin = begin, s.sample_end = end;
        draw_flare(*scene, camera, film, s);
    };
    const FilmLayout layout{.width = kWidth, .height = kHeight, .flare = true};
    Film one(layout), four(layout), first(layout), second(layout);
    drawn(1, 0, 5, one), drawn(4, 0, 5, four), drawn(2, 0, 2, first), drawn(3, 2, 5, second);
    first.merge(second);
    for (const Film* other : {&four, &first}) {
        const auto a = one.state("flare"), b = other->state("flare");
        CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    }
}

TEST_CASE("most rays of the sun's ghosts come to the film") {
    SceneDescription d;
    d.lights = {DirectionalLight{-normalize(Vec3f{0.08f, 0.1f, -1}), {1e5f, 1e5f, 1e5f}}};
    const auto scene = Scene::build(std::move(d));
    Film film(FilmLayout{.width = kWidth, .height = kHeight, .flare = true});
    const RenderCounters c = draw_flare(*scene, camera_with(test::wide_angle()), film, settings(1, 200000));
    INFO("share of rays on the film " << double(c.flare_hits) / double(c.flare_rays));
    CHECK(double(c.flare_hits) > 0.85 * double(c.flare_rays));
}
