// flare_scenes.h -- for tests: ghosts by light tracing, and a reference by rays traced backward from the film through
// the same surfaces, which look up the emission where they leave the lens and need no aiming or learning.
#pragma once
#include <random>

#include "render/flare/flare_pass.h"
#include "render/light_path_scenes.h"

namespace dg {

inline constexpr double kSensorWidth = 24, kSensorHeight = 18;   // mm
inline constexpr int kBlockColumns = kWidth / kBlock, kBlockCount = kBlockColumns * (kHeight / kBlock);

inline Camera camera_with(const Prescription& lens, const SensorStack& stack = {}) {
    ExactLensSettings s;
    s.f_stop = 4;
    s.half_diagonal_mm = 16;
    s.iris = Iris::polygon(6, 10, 0);
    Camera camera{Motion(Affine3d{}), ExactLens(lens, s)};
    camera.sensor_stack = stack;
    return camera;
}

inline RenderSettings settings(std::uint64_t seed, double paths) {
    RenderSettings s;
    s.sensor = {kWidth, kHeight, kSensorWidth, kSensorHeight, {0, 0}};
    s.filter = Filter(FilterKind::box);
    s.seed = seed;
    s.flare.per_sample = paths;
    return s;
}

inline std::vector<double> by_blocks(const std::vector<float>& xyz) {
    std::vector<double> blocks(kBlockCount);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            blocks[std::size_t(y / kBlock) * kBlockColumns + x / kBlock] +=
                xyz[3 * (std::size_t(y) * kWidth + x) + 1] / (kBlock * kBlock);
    return blocks;
}

inline RenderCounters draw_flare(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& s) {
    return render(scene, camera, film, s, nullptr);
}

inline Blocks forward(const Scene& scene, const Camera& camera, int pictures, double paths,
                      bool learned = true) {
    Blocks all;
    RenderSettings s = settings(0, paths);
    s.flare.learned = learned;
    s.flare.guide = std::make_shared<const FlareGuide>(std::make_shared<const FlareAim>(scene, camera, s), s);
    for (int k = 0; k < pictures; ++k) {
        s.seed = std::uint64_t(k) + 1;
        Film film(FilmLayout{.width = kWidth, .height = kHeight, .layers = {Layer::flare}});
        draw_flare(scene, camera, film, s);
        all.push_back(by_blocks(film.means("flare")));
    }
    return all;
}

/// Radiance of the emitter that a world ray hits first.
inline Rgb light_along(const Scene& scene, const Ray& ray) {
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

/// Uniform rays from film points toward a disc at the vertex of the last lens surface, through a ghost. The disc is
/// wider than the glass by the distance that rays move before they hit the curved surface, or mirrors and plates of the
/// body.
struct Backward {
    const Scene& scene;
    const ExactLens& lens;
    GhostLens ghosts;
    std::vector<Mirrors> mirrors = ghosts.two_bounces();
    std::vector<LensPath> paths;
    double rear, radius;   // mm
    bool reflected = false;   // includes light reflected by the scene

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
        std::vector<double> blocks(kBlockCount);
        for (int i = 0; i < rays; ++i) {
            const double px = u(rng), py = u(rng);   // fraction of the frame, from the top left
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
            const Spectrum light = seen(out, wl, std::uint32_t(i), seed) * value;
            blocks[std::size_t(int(py * kHeight) / kBlock) * kBlockColumns + std::size_t(int(px * kWidth) / kBlock)] +=
                wl.to_xyz(light).y * kBlockCount / rays;
        }
        return blocks;
    }
    Spectrum seen(const Ray& out, const Wavelengths& wl, std::uint32_t index, std::uint64_t seed) const {
        if (!reflected) return wl.emission(light_along(scene, out));
        PathSampler sampler(0, 0, index, seed);
        Wavelengths own = wl;
        PathSettings settings;
        settings.caustics = false;
        return radiance(scene, out, own, sampler, settings, nullptr, nullptr).sum();
    }
    Blocks pictures(int count, int rays) const {
        Blocks all;
        for (int k = 0; k < count; ++k) all.push_back(picture(rays, std::uint64_t(k) + 77));
        return all;
    }
};

/// Size of a frame that resolves the shape of ghosts.
inline constexpr int kWide = 160, kHigh = 120, kSide = 20;

inline RenderSettings wide_settings(std::uint64_t seed, double paths, bool maps = false) {
    RenderSettings s = settings(seed, paths);
    s.sensor = {kWide, kHigh, kSensorWidth, kSensorHeight, {0, 0}};
    s.filter = Filter();
    s.flare.maps = maps;
    return s;
}

/// Block means of X, Y and Z.
inline std::vector<double> blocks_of(const std::vector<float>& xyz) {
    constexpr int kAcross = kWide / kSide;
    std::vector<double> blocks(3 * std::size_t(kAcross) * (kHigh / kSide));
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x)
            for (int c = 0; c < 3; ++c)
                blocks[3 * std::size_t(y / kSide * kAcross + x / kSide) + c] +=
                    xyz[3 * (std::size_t(y) * kWide + x) + c] / (kSide * kSide);
    return blocks;
}

/// A scene with only the sun, inside the frame.
inline std::shared_ptr<const Scene> sunny() {
    SceneDescription d;
    d.lights = {SphereLight{{normalize(Vec3f{0.12f, 0.08f, -1}) * 1000.f, 4.6f}, {3e5f, 3e5f, 3e5f}}};
    return Scene::build(std::move(d));
}

/// Checks that `drawn(threads, begin, end, film)` adds bit-identical flare with one thread, with four, and in two
/// ranges.
template <typename Drawn>
void check_same_bits(const FilmLayout& layout, const Drawn& drawn) {
    Film one(layout), four(layout), first(layout), second(layout);
    drawn(1, 0, 5, one), drawn(4, 0, 5, four), drawn(2, 0, 2, first), drawn(3, 2, 5, second);
    first.merge(second);
    for (const Film* other : {&four, &first}) CHECK(std::ranges::equal(one.state("flare").bytes, other->state("flare").bytes));
}

/// Checks that crops of the frame of wide_settings() are bit-identical.
template <typename Drawn>
void check_crop(const Drawn& drawn) {
    Film one(FilmLayout{.width = kWide, .height = kHigh, .layers = {Layer::flare}});
    drawn(1, 0, 5, one);
    const FilmLayout part{.width = 40, .height = 30, .offset_x = 60, .offset_y = 50, .layers = {Layer::flare}};
    Film crop(part);
    drawn(2, 0, 5, crop);
    const std::vector<float> all = one.means("flare"), own = crop.means("flare");
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            CHECK(own[3 * (std::size_t(y) * part.width + x) + 1] ==
                  all[3 * (std::size_t(y + part.offset_y) * kWide + x + part.offset_x) + 1]);
}

inline std::string show(const Blocks& b) {
    const SampleMoments m = whole(b);
    return std::to_string(m.mean) + " +- " + std::to_string(std::sqrt(m.variance / m.count)) + " ";
}

}  // namespace dg
