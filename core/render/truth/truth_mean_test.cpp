// Mean ground truth against closed forms: edges out of focus, planes in focus.
#include "render/truth/truth_mean.h"

#include <doctest/doctest.h>

#include "optics/lens/test_lenses.h"
#include "scene/test_scenes.h"

namespace dg {
namespace {

const Sensor kSensor{40, 30, 36, 27};   // px of 0.9 mm
const FilmLayout kAll{kSensor.width, kSensor.height, 0, 0};
constexpr double kPixels = 50 / 0.9;    // film distance of the 50 mm lens, px
constexpr double kRadius = 0.0125;      // radius of the iris, m: 50 mm at f/2
constexpr double kFocus = 0.25;         // m
constexpr int kRays = 1024;

std::shared_ptr<const Motion> placed(Vec3d origin, double scale, Vec3d per_second = {}) {
    Affine3d begin{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, origin}, end = begin;
    begin.origin = origin - per_second, end.origin = origin + per_second;
    const std::array times{-1.0, 1.0};
    const std::array keys{begin, end};
    return std::make_shared<const Motion>(Motion::keys(times, keys, Interpolation::linear));
}

/// A wall at z = -6, and in front of it a wall at z = -2 that covers x < 0.
struct World {
    LensKind lens = ThinLens{50, 1e3 * kRadius, kFocus, {}, false};
    double near_scale = 10, near_right = 0;   // m; x of its right edge
    Vec3d near_speed{0, 0, 0}, far_speed{0, 0, 0};

    struct Shot {
        std::shared_ptr<const Scene> scene;
        Camera camera;
        RenderSettings settings;
        operator TruthFrame() const { return {*scene, camera}; }
    };
    Shot at(double seconds) const {
        SceneDescription d = describe(quad_mesh(), GltfMaterial{});
        d.materials.push_back(d.materials[0]);
        d.instances.push_back({"far", 0, 1, {}});
        d.instances[0].motion = placed({near_right - near_scale, 0, -2}, near_scale, near_speed);
        d.instances[1].motion = placed({0, 0, -6}, 20, far_speed);
        d.interval = {seconds, seconds};
        Shot shot{Scene::build(std::move(d)), {Motion(Affine3d{}), lens}, RenderSettings()};
        shot.settings.sensor = kSensor;
        shot.settings.shutter = Shutter({}, kSensor.width, kSensor.height);
        return shot;
    }
};

/// Fraction of the unit disc to the left of x.
double share_left(double x) {
    const double t = std::clamp(x, -1.0, 1.0);
    return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPiD;
}

/// Share of the light of a column's pixels from the near wall. A ray from the iris point p crosses z = -2 at
/// 2 chief + p (1 - 2 / focus).
double near_share(int column) {
    double sum = 0;
    for (int i = 0; i < 64; ++i) {
        const double chief = (column + (i + 0.5) / 64 - 20) / kPixels;
        sum += share_left(-2 * chief / (kRadius * std::abs(1 - 2 / kFocus)));
    }
    return sum / 64;
}

std::size_t middle_row(int column) { return std::size_t(15) * 40 + column; }

}  // namespace

TEST_CASE("out of focus, an edge is each side by its share of the iris") {
    const World world;
    const World::Shot shot = world.at(0);
    const MeanTruth truth = see_mean(shot, kAll, shot.settings, kRays);
    int mixed = 0;
    for (int x = 17; x < 23; ++x) {
        const double near = near_share(x);
        mixed += near > 0.05 && near < 0.95;
        const std::size_t i = middle_row(x);
        CHECK(truth.depth[i] == doctest::Approx(6 - 4 * near).epsilon(0.004));
        CHECK(truth.object_id[i] == (near > 0.5 ? 1u : 2u));
        CHECK(truth.material_id[i] == (near > 0.5 ? 1u : 2u));
        CHECK(truth.coverage[i] == 1);
        CHECK(truth.normal[i].z == 1);
    }
    CHECK(mixed >= 4);
}

TEST_CASE("coverage is the share of the light that meets something") {
    World world;
    world.near_scale = 0.05;   // a square with its right edge at x = 0
    World::Shot shot = world.at(0);
    SceneDescription d = shot.scene->description();
    d.instances.pop_back();
    shot.scene = Scene::build(std::move(d));
    const MeanTruth truth = see_mean(shot, kAll, shot.settings, kRays);
    double covered = 0;
    for (std::size_t i = 0; i < truth.coverage.size(); ++i) {
        covered += truth.coverage[i];
        if (truth.coverage[i] > 0)
            CHECK(truth.depth[i] == doctest::Approx(2).epsilon(1e-5));
        CHECK((truth.object_id[i] == 1) == (truth.coverage[i] > 0.5));
    }
    // Blur preserves the covered area (px2).
    CHECK(covered == doctest::Approx(std::pow(0.1 / 2 * kPixels, 2)).epsilon(0.01));
}

TEST_CASE("in focus the means are what the chief rays meet") {
    World world;
    world.near_right = -100;   // outside the frame
    const LensKind lenses[] = {
        ThinLens{50, 1e3 * kRadius, 6, {}, true},
        ExactLens(test::check_lens(false, 0.5), {2.8, {}, 6, FocusFrom::pupil, 24})};
    for (const LensKind& lens : lenses) {
        world.lens = lens;
        const World::Shot shot = world.at(0);
        const MeanTruth mean = see_mean(shot, kAll, shot.settings, kRays);
        const Truth chief = see(shot, kAll, shot.settings);
        const double pixel = 6 / kPixels;
        for (std::size_t i = 0; i < mean.depth.size(); ++i) {
            CHECK(mean.depth[i] == doctest::Approx(6).epsilon(1e-5));
            CHECK(length(mean.position[i] - chief.position[i]) < 0.03 * pixel);
        }
    }
}

TEST_CASE("means of motion are by share, too, and 0 where nothing moves") {
    World world;
    world.far_speed = {0.6, 0, 0};   // 1 m/s is kPixels / 6 px per s
    const World::Shot now = world.at(0), then = world.at(0.1);
    const auto motion = mean_motion(now, now.settings, then, then.settings, kAll, kRays);
    for (int x = 17; x < 23; ++x) {
        const double far = 1 - near_share(x);
        CHECK(motion[middle_row(x)].x == doctest::Approx(far * kPixels * 0.01).epsilon(0.01));
        CHECK(std::abs(motion[middle_row(x)].y) < 1e-3);
    }
    const auto still = mean_motion(now, now.settings, now, now.settings, kAll, 16);
    for (const Vec2d v : still) CHECK(length(v) < 1e-9);
}

TEST_CASE("the same frame has the same bits on any number of threads") {
    const World world;
    World::Shot shot = world.at(0);
    shot.settings.threads = 1;
    const MeanTruth one = see_mean(shot, kAll, shot.settings, 16);
    shot.settings.threads = 3;
    CHECK(one.depth == see_mean(shot, kAll, shot.settings, 16).depth);
}

}  // namespace dg
