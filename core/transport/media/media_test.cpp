// Paths in media, compared with scenes of known radiance.
#include <doctest/doctest.h>

#include <functional>

#include "math/error.h"
#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

constexpr float kEndless = std::numeric_limits<float>::infinity();

std::shared_ptr<const Medium> medium(SpectralColor absorption, SpectralColor scattering,
                                     std::vector<PhaseLobe> lobes = {{0, 1}}, SpectralColor emission = {}) {
    return std::make_shared<const Medium>(Medium{absorption, scattering, emission, Phase(lobes)});
}
SpectralColor grey(float v) { return {v, v, v}; }

/// The medium with a density grid on the cube [-1, 1]^3: density 1, or with `uneven` 2 x, for x from 0 to 1.
std::shared_ptr<const Medium> on_grid(Medium m, bool uneven = false) {
    constexpr std::uint32_t kCells = 20;
    std::vector<float> values(kCells * kCells * kCells, 1.f);
    if (uneven)
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = (float(i % kCells) + 0.5f) / kCells * 2;
    const Affine3d cube{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {-1, -1, -1}};
    m.density = std::make_shared<const DensityGrid>(DensityGrid::Size{kCells, kCells, kCells}, std::move(values), cube);
    return std::make_shared<const Medium>(std::move(m));
}

/// Adds a closed mesh as an invisible boundary of a medium.
void fill(SceneDescription& d, Mesh mesh, std::shared_ptr<const Medium> inside) {
    add(d, std::move(mesh), {"boundary", DiffuseMaterial{}});
    d.media.of_material[std::uint32_t(d.materials.size() - 1)] = {std::int32_t(d.media.all.size()), -1, true};
    d.media.all.push_back(std::move(inside));
}
void fill_world(SceneDescription& d, std::shared_ptr<const Medium> fog) {
    d.media.fog = std::int32_t(d.media.all.size());
    d.media.all.push_back(std::move(fog));
}

/// Luminances of n paths along one ray.
SampleMoments look(const Scene& scene, const Ray& ray, const PathSettings& settings, int n, bool alone = false) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        PathSampler sampler(i / 1024, 5, std::uint32_t(i % 1024), 11);
        Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        if (alone) wavelengths.end_secondary();
        const Spectrum l = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr).sum();
        values.push_back(wavelengths.to_xyz(l).y);
    }
    return moments(values);
}

bool agrees(const SampleMoments& m, double expected, double relative = 2e-3) {
    return std::abs(m.mean - expected) < 4 * std::sqrt(m.variance / m.count) + relative * expected;
}
/// A tighter check than agrees(): samples are stratified, so the error of the mean is below its standard error.
bool finds(const SampleMoments& m, double expected, double percent = 0.5) {
    return std::abs(m.mean - expected) < percent / 100 * expected;
}

PathSettings deep(int depth) {
    PathSettings settings;
    settings.max_depth = depth;
    return settings;
}

/// Luminances of a cube by MIS, by light sampling and by BSDF sampling, after a check that they agree.
std::vector<SampleMoments> by_every_strategy(const Scene& scene, PathSettings settings) {
    std::vector<SampleMoments> found;
    using Strategy = PathSettings::Strategy;
    for (const auto strategy : {Strategy::mis, Strategy::light, Strategy::bsdf}) {
        settings.strategy = strategy;
        found.push_back(look(scene, test_ray({0, 0, 4}, {0, 0, -1}), settings, 1 << 17));
    }
    CHECK(welch_p_value(found[0], found[1]) > 1e-3);
    CHECK(welch_p_value(found[0], found[2]) > 1e-3);
    return found;
}

/// Single scattering of a lamp of 1 cd, integrated numerically along the ray.
double scattered_once(Vec3d lamp, double albedo, double extinction, const Phase& phase, double end) {
    constexpr int kSteps = 200000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = end * (i + 0.5) / kSteps;
        const Vec3d to = lamp - Vec3d{0, 0, -t};
        const double r = length(to);
        const float p = phase.value({0, 0, 1}, to_float(to / r));
        sum += albedo * extinction * double(p) * std::exp(-extinction * (t + r)) / (r * r);
    }
    return sum * end / kSteps;
}

}  // namespace

/// Runs a check on the luminance along -z for each sampling of distances.
template <typename Check>
void look_by_each_way(const Scene& scene, double expected, const Check& check) {
    using Distances = PathSettings::Distances;
    for (const auto distances : {Distances::both, Distances::equiangular, Distances::free}) {
        PathSettings settings = deep(1);
        settings.distances = distances;
        const SampleMoments m = look(scene, test_ray({}, {0, 0, -1}), settings, 1 << 16);
        CAPTURE(expected);
        CAPTURE(m.mean);
        check(distances, m);
    }
}

TEST_CASE("a lamp in fog shines as the integral along the ray says, by every way to draw distances") {
    const std::vector<PhaseLobe> lobes{{0.5f, 3}, {-0.2f, 1}};
    for (const Vec3f lamp : {Vec3f{0.3f, 0.1f, -2}, Vec3f{-1, 0, 0.5f}, Vec3f{0, 2, -6}})
        for (const double density : {0.05, 0.6}) {
            SceneDescription d;
            fill_world(d, medium(grey(float(0.2 * density)), grey(float(0.8 * density)), lobes));
            d.lights.push_back(PointLight{lamp, {1, 1, 1}});
            const auto scene = Scene::build(std::move(d));
            const double expected = scattered_once(to_double(lamp), 0.8, density, Phase(lobes), 200);
            look_by_each_way(*scene, expected, [&](PathSettings::Distances distances, const SampleMoments& m) {
                CHECK(agrees(m, expected));
                if (distances == PathSettings::Distances::both) CHECK(finds(m, expected));
            });
        }
}

TEST_CASE("many lamps in fog shine as each of them does") {
    SceneDescription d;
    fill_world(d, medium(grey(0.05f), grey(0.2f)));
    double expected = 0;
    for (int i = 0; i < 12; ++i) {
        const auto u = [&](int k) { return float(hash_uniform(k, i)); };
        const Vec3f lamp{u(1) * 4 - 2, u(2) * 4 - 2, -6 * u(3)};
        const float cd = 0.2f + 2 * u(4);
        d.lights.push_back(PointLight{lamp, {cd, cd, cd}});
        expected += double(cd) * scattered_once(to_double(lamp), 0.8, 0.25, Phase(), 100);
    }
    const auto scene = Scene::build(std::move(d));
    CHECK(finds(look(*scene, test_ray({}, {0, 0, -1}), deep(1), 1 << 16), expected, 1));
}

TEST_CASE("a lamp of triangles in fog lights places that most of them are turned away from") {
    // Each face lights only a part of the ray, and no face is visible from the whole ray.
    constexpr float kHalf = 0.01f, kRadiance = 1000;
    const Vec3f centre{0.4f, 0.1f, -2};
    SceneDescription d;
    fill_world(d, medium(grey(0.05f), grey(0.2f)));
    Mesh cube = cube_mesh();
    std::vector<Vec3f> corners(cube.positions.begin(), cube.positions.end());
    for (Vec3f& corner : corners) corner = centre + corner * kHalf;
    cube.positions = corners;
    add(d, std::move(cube), {"lamp", DiffuseMaterial{{0, 0, 0}}, {kRadiance, kRadiance, kRadiance}});
    const auto scene = Scene::build(std::move(d));
    constexpr int kSteps = 200000;
    double expected = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = 100 * (i + 0.5) / kSteps;
        const Vec3d to = to_double(centre) - Vec3d{0, 0, -t};
        const double r = length(to);
        const double seen = 4 * kHalf * kHalf * (std::abs(to.x) + std::abs(to.y) + std::abs(to.z)) / r;
        expected += 0.2 / (4 * kPiD) * std::exp(-0.25 * (t + r)) * kRadiance * seen / (r * r);
    }
    expected *= 100.0 / kSteps;
    look_by_each_way(*scene, expected, [&](PathSettings::Distances distances, const SampleMoments& m) {
        CHECK(finds(m, expected, distances == PathSettings::Distances::free ? 5 : 1));
    });
}

TEST_CASE("a slab of a medium leaves exp(-optical depth) of what lies behind, and of what lights a surface") {
    for (const bool grid : {false, true}) {
        SceneDescription d;
        const auto absorbing = medium(grey(0.7f), {});
        fill(d, cube_mesh(), grid ? on_grid(*absorbing, true) : absorbing);
        d.environment = Environment::constant({1, 1, 1});
        const auto scene = Scene::build(std::move(d));
        const double percent = grid ? 1.5 : 0.5;   // ratio tracking is random where densities differ
        CHECK(finds(look(*scene, test_ray({0, 0, 5}, {0, 0, -1}), deep(1), 1 << 14), std::exp(-1.4), percent));
        CHECK(finds(look(*scene, test_ray({0, 0, 0}, {0, 0, -1}), deep(1), 1 << 14), std::exp(-0.7), percent));
        CHECK(finds(look(*scene, test_ray({5, 0, 0}, {0, 0, -1}), deep(1), 1 << 10), 1));
        const double dark = 0.7 * (grid ? 0.125 + 0.00125 : 0.5);   // half of the last cell is as dense as its centre
        CHECK(finds(look(*scene, test_ray({-0.5f, 0, 0}, {-1, 0, 0}), deep(1), 1 << 14),
                    std::exp(-dark)));
    }
    for (const bool grid : {false, true}) {
        SceneDescription d;
        const auto absorbing = medium(grey(0.7f), {});
        fill(d, cube_mesh(), grid ? on_grid(*absorbing) : absorbing);

        add(d, quad_mesh(), {"floor", DiffuseMaterial{{0.5f, 0.5f, 0.5f}}});
        d.instances.back().world_from_local.origin = {0, 0, -2};
        d.lights.push_back(DirectionalLight{{0, 0, -1}, {kPi, kPi, kPi}});
        const auto scene = Scene::build(std::move(d));
        CHECK(finds(look(*scene, test_ray({3, 0, -1.2f}, {-3, 0, -0.8f}), deep(1), 1 << 12), 0.5 * std::exp(-1.4)));
    }
}

TEST_CASE("a cloud that absorbs nothing cannot be seen in an even world") {
    const std::vector<std::vector<PhaseLobe>> phases{{{0, 1}}, {{0.8f, 2}, {-0.4f, 1}}};
    for (const auto& lobes : phases)
        for (const bool grid : {false, true})
            for (const bool colorful : {false, true}) {
                SceneDescription d;
                const auto cloud = medium({}, colorful ? SpectralColor{3, 0.8f, 0.1f} : grey(2), lobes);
                fill(d, cube_mesh(), grid ? on_grid(*cloud, true) : cloud);
                d.environment = Environment::constant({1, 1, 1});
                const auto scene = Scene::build(std::move(d));
                PathSettings settings = deep(400);
                settings.roulette_depth = 1000;
                CHECK(agrees(look(*scene, test_ray({0.1f, 0.2f, 5}, {0, 0, -1}), settings, 4096), 1));
                CHECK(agrees(look(*scene, test_ray({0.5f, 0, 0}, {0.3f, 1, -1}), deep(400), 1 << 14), 1, 5e-3));
            }
}

TEST_CASE("a medium shines with (1 - exp(-optical depth)) j / s") {
    for (const bool grid : {false, true})
        for (const bool alone : {false, true}) {
            SceneDescription d;
            const auto flame = medium({0.5f, 0.2f, 0.1f}, {}, {{0, 1}}, {3, 2, 1});
            fill(d, cube_mesh(), grid ? on_grid(*flame) : flame);
            const auto scene = Scene::build(std::move(d));
            double expected = 0;   // mean over wavelengths, as they are sampled
            for (int i = 0; i < 4096; ++i) {
                const Wavelengths w = Wavelengths::sample((i + 0.5f) / 4096);
                const MediumAt m = flame->at(w);
                Spectrum l;
                for (int k = 0; k < 4; ++k) {
                    const float met = 1 - std::exp(-2 * m.extinction[k]);
                    l.set(k, m.emission[k] * met / m.extinction[k]);
                }
                expected += double(w.to_xyz(l).y) / 4096;
            }
            CHECK(finds(look(*scene, test_ray({0, 0, 5}, {0, 0, -1}), deep(1), 1 << 16, alone), expected, 1));
        }
}

TEST_CASE("lamps of some size in fog are found the same by their light, by the phase function and by both") {
    for (int kind = 0; kind < 4; ++kind) {
        const bool grid = kind & 1, many = kind & 2;
        SceneDescription d;
        const auto fog = medium({0.02f, 0.05f, 0.1f}, {0.3f, 0.25f, 0.2f}, {{0.6f, 1}});
        if (grid)
            fill_world(d, on_grid(*fog));
        else
            fill_world(d, fog);
        d.lights.push_back(SphereLight{{{0.5f, 0.3f, 0}, 0.3f}, {10, 10, 10}});
        d.lights.push_back(SphereLight{{{-0.6f, -0.5f, 0.4f}, 0.2f}, {5, 9, 20}});
        for (int i = 0; many && i < 5; ++i)
            d.lights.push_back(SphereLight{{{0.1f * float(i), -1, 0.3f * float(i)}, 0.05f}, {40, 40, 9}});
        const auto scene = Scene::build(std::move(d));
        const std::vector<SampleMoments> found = by_every_strategy(*scene, deep(6));
        CHECK(found[0].variance < found[2].variance);
    }
}

TEST_CASE("a medium of one number finds the same by one wavelength as by four, and on a grid as without") {
    std::vector<SampleMoments> found;
    for (const bool grid : {false, true})
        for (const bool alone : {false, true}) {
            SceneDescription d;
            const auto smoke = medium({0.1f, 0.3f, 0.9f}, {2, 1, 0.5f}, {{0.3f, 1}});
            fill(d, cube_mesh(), grid ? on_grid(*smoke) : smoke);
            d.environment = Environment::constant({1, 0.5f, 0.2f});
            const auto scene = Scene::build(std::move(d));
            found.push_back(look(*scene, test_ray({0.2f, 0, 4}, {0, 0.05f, -1}), deep(100), 1 << 16, alone));
        }
    for (const SampleMoments& m : found) CHECK(welch_p_value(found[0], m) > 1e-3);
}

TEST_CASE("a lamp in thin smoke is found the same by every strategy, though paths are scattered seldomer than light") {
    SceneDescription d;
    fill(d, cube_mesh(), medium(grey(0.02f), grey(0.3f), {{0.95f, 1}}));
    d.lights.push_back(SphereLight{{{0.5f, 0, -0.4f}, 0.45f}, {10, 10, 10}});
    const auto scene = Scene::build(std::move(d));
    const std::vector<SampleMoments> found = by_every_strategy(*scene, deep(2));
    PathSettings alone = deep(2);
    alone.strategy = PathSettings::Strategy::bsdf;
    const SampleMoments paths = look(*scene, test_ray({0, 0, 4}, {0, 0, -1}), alone, 1 << 20);   // 0.6 % of noise
    CAPTURE(found[0].mean);
    CAPTURE(paths.mean);
    CHECK(finds(found[0], paths.mean, 1));
}

TEST_CASE("paths that end in the dark are made up for by those that go on: a grid, where none ends, shines the same") {
    std::vector<SampleMoments> found;
    for (const bool grid : {false, true}) {
        SceneDescription d;
        const auto smoke = medium(grey(0.1f), grey(1.2f), {{0.5f, 1}});
        fill(d, cube_mesh(), grid ? on_grid(*smoke) : smoke);
        d.lights.push_back(PointLight{{0.8f, 0.7f, 1.3f}, {1, 1, 1}});
        d.lights.push_back(SphereLight{{{0.7f, -0.8f, 1.3f}, 0.1f}, {30, 30, 30}});
        const auto scene = Scene::build(std::move(d));
        found.push_back(look(*scene, test_ray({0.75f, 0.4f, 4}, {-0.12f, 0, -1}), deep(12), 1 << 19));
    }
    CAPTURE(found[0].mean);
    CAPTURE(found[1].mean);
    CHECK(welch_p_value(found[0], found[1]) > 1e-3);
    SampleMoments darker = found[0];
    darker.mean *= 0.97;
    CHECK(welch_p_value(darker, found[1]) < 1e-3);
}

TEST_CASE("media move with their meshes, at the time of the ray") {
    for (const bool grid : {false, true}) {
        SceneDescription d;
        const auto absorbing = medium(grey(0.5f), {});
        fill(d, cube_mesh(), grid ? on_grid(*absorbing) : absorbing);
        d.environment = Environment::constant({1, 1, 1});
        d.interval = {0, 1};
        std::vector<Affine3d> poses{{}, {}};
        poses[1].origin = {4, 0, 0};
        const std::vector<double> times{0, 1};
        d.instances.back().motion = std::make_shared<const Motion>(Motion::keys(times, poses, Interpolation::linear));
        const auto scene = Scene::build(std::move(d));
        for (const float time : {0.f, 0.5f, 1.f})
            for (const float x : {0.f, 2.f, 4.f}) {
                Ray ray = test_ray({x, 0.1f, 5}, {0, 0, -1});
                ray.time = time;
                const bool inside = std::abs(x - 4 * time) < 1;
                CHECK(agrees(look(*scene, ray, deep(2), 1024), inside ? std::exp(-1.) : 1));
            }
    }
}

TEST_CASE("a medium within a medium takes its place, and light that leaves is in the outer one again") {
    SceneDescription d;
    fill(d, cube_mesh(), medium(grey(0.4f), {}));
    Mesh inner = cube_mesh();
    fill(d, inner, medium(grey(1.2f), {}));
    d.media.of_material[1].outside = 0;
    d.instances.back().world_from_local = {{0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}, {}};
    d.environment = Environment::constant({1, 1, 1});
    const auto scene = Scene::build(std::move(d));
    const double outer = 0.4, middle = 1.2;
    CHECK(finds(look(*scene, test_ray({0, 0, 5}, {0, 0, -1}), deep(1), 4096), std::exp(-outer - middle)));
    CHECK(finds(look(*scene, test_ray({0, 0, 0.75f}, {0, 0, -1}), deep(1), 4096), std::exp(-0.75 * outer - middle)));
    CHECK(finds(look(*scene, test_ray({0, 0, 0}, {0, 0, -1}), deep(1), 4096), std::exp(-0.5 * (outer + middle))));
}

TEST_CASE("what a medium takes away counts as covered, and nothing else of it is seen") {
    for (const bool grid : {false, true}) {
        SceneDescription d;
        const auto smoke = medium(grey(0.2f), grey(0.3f));
        fill(d, cube_mesh(), grid ? on_grid(*smoke) : smoke);
        add(d, quad_mesh(), {"wall", DiffuseMaterial{}});
        d.instances.back().world_from_local.origin = {0, 0, -3};
        const auto scene = Scene::build(std::move(d));
        const auto hit = scene->first_hit(test_ray({0.2f, 0.3f, 5}, {0, 0, -1}));
        REQUIRE(hit);
        CHECK(hit->instance == 1);
        CHECK(hit->t == doctest::Approx(8));
        CHECK_FALSE(scene->first_hit(test_ray({0.2f, 0.3f, 5}, {0.2f, 0, -1})));
        double covered = 0, by_wall = 0;
        constexpr int kCount = 1 << 14;
        for (int i = 0; i < kCount; ++i) {
            PathSampler sampler(3, 5, std::uint32_t(i), 11);
            const Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
            const Ray ray = test_ray({0.2f, 0.3f, 5}, {0, 0, -1});
            const Sight sight = trace_camera_ray(*scene, ray, wavelengths, sampler, deep(3), nullptr, nullptr);
            covered += double(sight.covers.sum()) / kCount;
            for (const Cover& c : sight.covers) {
                CHECK(c.instance == 1);
                by_wall += double(c.share) / kCount;
            }
        }
        CHECK(covered == doctest::Approx(1).epsilon(1e-3));
        CHECK(by_wall == doctest::Approx(std::exp(-1.)).epsilon(0.01));
    }
}

TEST_CASE("media that the scene has not are refused") {
    SceneDescription d;
    d.media.fog = 0;
    CHECK_THROWS_AS(Scene::build(d), Error);
    d = {};
    d.media.of_material[0] = {};
    CHECK_THROWS_AS(Scene::build(d), Error);
}

}  // namespace dg
