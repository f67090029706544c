// Ground truth against closed forms: planes, pans, spins, rolling shutters.
#include "render/truth/truth.h"

#include <doctest/doctest.h>

#include "camera/inverse/chief.h"
#include "math/quaternion.h"
#include "optics/lens/test_lenses.h"
#include "scene/test_scenes.h"

namespace dg {
namespace {

constexpr double kFrame = 0.1;         // s from frame to frame
const Sensor kSensor{40, 30, 36, 27};  // px of 0.9 mm
constexpr double kPixels = 50 / 0.9;   // film distance of the 50 mm lens, px

Affine3d turned(Vec3d axis, double degrees, Vec3d origin) {
    Affine3d m = to_matrix(Quaterniond::from_axis_angle(axis, degrees * kPiD / 180));
    m.origin = origin;
    return m;
}

Motion between(double begin, const Affine3d& a, double end, const Affine3d& b,
               Interpolation how = Interpolation::linear) {
    const std::array times{begin, end};
    const std::array keys{a, b};
    return Motion::keys(times, keys, how);
}

/// Motion with a constant velocity from the pose `m` at time 0.
Motion drifting(const Affine3d& m, Vec3d per_second) {
    Affine3d before = m, after = m;
    before.origin = before.origin - per_second, after.origin = after.origin + per_second;
    return between(-1, before, 1, after);
}

/// A quad of half side 3 at z = -4, moved by `motion`, in front of a camera.
struct World {
    Motion motion = turned({0, 0, 1}, 0, {0, 0, -4});
    Motion camera = Affine3d{};  // over time in s
    LensKind lens = Pinhole{50, false};
    ShutterSettings shutter{};  // for ground truth: exposure 0, with lines
    SceneDescription description = describe(quad_mesh(), GltfMaterial{});
    float size = 3;

    struct Shot {
        std::shared_ptr<const Scene> scene;
        Camera camera;
        RenderSettings settings;
        operator TruthFrame() const { return {*scene, camera}; }
    };
    Shot at(double begin) const {
        Shot shot{nullptr, {camera, lens}, RenderSettings()};
        shot.settings.sensor = kSensor;
        shot.settings.shutter = Shutter(shutter, kSensor.width, kSensor.height);
        const TimeInterval interval{begin, begin + shot.settings.shutter.duration_s()};
        shot.camera.world_from_camera = camera.over(interval.open, interval.close);
        SceneDescription d = description;
        std::vector<Vec3f> corners{d.meshes[0].positions.begin(), d.meshes[0].positions.end()};
        for (Vec3f& p : corners) p = {size * p.x, size * p.y, p.z};
        d.meshes[0].positions = corners;
        d.instances[0].motion = std::make_shared<const Motion>(motion);
        d.interval = interval;
        shot.scene = Scene::build(std::move(d));
        return shot;
    }
};

const FilmLayout kAll{kSensor.width, kSensor.height, 0, 0};

Vec2d centre(std::size_t i) {
    return {double(i % kSensor.width) + 0.5, double(i / kSensor.width) + 0.5};
}

/// Largest distance, px, between positions a frame later and `expected`(pixel center). Planted faults: `sign` -1 uses
/// the frame before, `off` shifts the centers.
template <typename Expected>
double worst(const World& world, const Expected& expected, double sign = 1,
             Vec2d off = {}) {
    const World::Shot now = world.at(0), next = world.at(sign * kFrame);
    const Truth truth = see(now, kAll, now.settings);
    const auto from = places(truth, now, now.settings),
               to = places(truth, next, next.settings);
    double worst = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec2d wanted = expected(centre(i) + off);
        const double miss = std::max(length(to[i] - wanted), length(from[i] - centre(i)));
        worst = miss <= worst ? worst : miss;  // propagates NaN
        if (std::isnan(miss)) return miss;
    }
    return worst;
}

/// Converts film px to px relative to the axis with y up; it is its own inverse.
Vec2d up(Vec2d px) {
    return {px.x - 20, 15 - px.y};
}
Vec2d down(Vec2d v) {
    return {v.x + 20, 15 - v.y};
}

}  // namespace

TEST_CASE(
    "a still plane: exact depth, distance, position, normal and ids; nothing moves") {
    const World world;
    const World::Shot shot = world.at(0);
    const Truth truth = see(shot, kAll, shot.settings);
    for (std::size_t i = 0; i < truth.seen.size(); ++i) {
        const Vec2d v = up(centre(i)) * (4 / kPixels);
        CHECK(truth.depth[i] == doctest::Approx(4).epsilon(1e-6));
        CHECK(truth.distance[i] ==
              doctest::Approx(std::hypot(v.x, v.y, 4.0)).epsilon(1e-6));
        CHECK(length(truth.position[i] - to_float(Vec3d{v.x, v.y, -4})) < 1e-5f);
        CHECK(truth.normal[i].z == 1);
        CHECK(truth.object_id[i] == 1);
        CHECK(truth.material_id[i] == 1);
    }
    CHECK(worst(world, [](Vec2d px) { return px; }) < 1e-3);
    CHECK(worst(world, [](Vec2d px) { return px; }, 1, {0.5, 0.5}) > 0.1);
}

TEST_CASE("a thin lens sees what the pinhole sees") {
    World thin;
    thin.lens = ThinLens{50, 12.5, 2, {}, false};
    const World::Shot a = World().at(0), b = thin.at(0);
    CHECK(see(a, kAll, a.settings).depth == see(b, kAll, b.settings).depth);
}

TEST_CASE("a quad that drifts and one that spins") {
    World world;
    world.motion = drifting(turned({0, 0, 1}, 0, {0, 0, -4}), {0.5, 0.25, -2});
    const auto drifted = [](Vec2d px) {
        const Vec2d at = up(px) * (4 / kPixels);
        return down(Vec2d{at.x + 0.05, at.y + 0.025} * (kPixels / 4.2));
    };
    CHECK(worst(world, drifted) < 1e-3);
    CHECK(worst(world, drifted, -1) > 0.5);
    world.motion =
        Motion(turned({0, 0, 1}, 0, {0, 0, -4})).spinning({{0, 0, 1}, 3.5, {0, 0, 0}, 0});
    const double a = 2 * kPiD * 0.35;
    const auto spun = [a](Vec2d px) {
        const Vec2d v = up(px);
        return down({std::cos(a) * v.x - std::sin(a) * v.y,
                     std::sin(a) * v.x + std::cos(a) * v.y});
    };
    CHECK(worst(world, spun) < 1e-3);
    CHECK(worst(world, spun, -1) > 0.5);
}

TEST_CASE("a pan moves what is near and the background alike") {
    for (const float size : {3.f, 1e-3f}) {  // the small quad leaves the background visible
        World world;
        world.size = size;
        world.camera = between(-1, turned({0, 1, 0}, -30, {}), 1,
                               turned({0, 1, 0}, 30, {}), Interpolation::twist);
        const double a = 3 * kPiD / 180;  // pans left, so that images move right
        const auto panned = [a](Vec2d px) {
            const Vec2d v = up(px) * (1 / kPixels);
            const double x = std::cos(a) * v.x + std::sin(a),
                         z = std::cos(a) - std::sin(a) * v.x;
            return down(Vec2d{x / z, v.y / z} * kPixels);
        };
        CHECK(worst(world, panned) < 1e-3);
        CHECK(worst(world, panned, -1) > 0.5);
    }
}

TEST_CASE("a rolling shutter: the line on which a point lands has its own time") {
    World world;
    const double speed = 1;  // m/s, downward
    world.motion = drifting(turned({0, 0, 1}, 0, {0, 0, -4}), {0, -speed, 0});
    for (const ScanOrder scan : {ScanOrder::top, ScanOrder::bottom}) {
        world.shutter = {0, OpeningCurve(), scan, 2e-3};
        // Later by a frame time, and by a line time for each line (from the top).
        const double lines_per_s = speed * kPixels / 4,
                     line_s = scan == ScanOrder::top ? 2e-3 : -2e-3;
        const double fall = lines_per_s * kFrame / (1 - lines_per_s * line_s);
        double off = 0, plain = 0;
        const World::Shot now = world.at(0), next = world.at(kFrame);
        const Truth truth = see(now, kAll, now.settings);
        const auto to = places(truth, next, next.settings);
        for (std::size_t i = 0; i < to.size(); ++i) {
            if (to[i].y > 29.5) continue;  // beyond the last line its time is used
            off = std::max(off, std::abs(to[i].y - centre(i).y - fall));
            plain =
                std::max(plain, std::abs(to[i].y - centre(i).y - lines_per_s * kFrame));
        }
        CHECK(off < 1e-3);
        CHECK(plain > 0.02);  // planted fault: no row times
    }
}

TEST_CASE("through an exact lens a point lies where its chief ray meets the film") {
    World world;
    world.lens = ExactLens(test::tessar(), {4, {}, 2, FocusFrom::pupil, 24});
    CHECK(worst(world, [](Vec2d px) { return px; }) < 1e-3);
    world.motion = drifting(turned({0, 0, 1}, 0, {0, 0, -4}), {0.5, 0, 0});
    const ChiefRays chief(world.lens);
    const auto drifted = [&](Vec2d px) {
        const ChiefRay ray = chief.at(kSensor.mm_from_px(px));
        const Vec3d p =
            ray.origin + ray.direction * ((-4 - ray.origin.z) / ray.direction.z);
        return kSensor.px_from_mm(*chief.film_point(p + Vec3d{0.05, 0, 0}));
    };
    CHECK(worst(world, drifted) < 1e-3);
}

TEST_CASE("what is hidden or behind the camera in the other frame has no place there") {
    World world;
    world.description.instances[0].shown =
        std::make_shared<const Shown>(Shown{{{-1, 0.05}}});
    const World::Shot now = world.at(0), next = world.at(kFrame);
    const Truth truth = see(now, kAll, now.settings);
    CHECK(std::isnan(places(truth, next, next.settings)[0].x));
    CHECK(!std::isnan(places(truth, now, now.settings)[0].x));
    World passing;
    passing.motion = drifting(turned({0, 0, 1}, 0, {0, 0, -4}), {0, 0, 50});
    const World::Shot before = passing.at(0), after = passing.at(kFrame);
    CHECK(std::isnan(
        places(see(before, kAll, before.settings), after, after.settings)[0].x));
}

TEST_CASE("a sphere light is a surface without an object") {
    World world;
    world.description.lights = {SphereLight{{{0, 0, -3}, 0.5f}, {1, 1, 1}}};
    const World::Shot shot = world.at(0);
    const Truth truth = see(shot, kAll, shot.settings);
    const std::size_t middle = 15 * 40 + 20;
    CHECK(truth.depth[middle] == doctest::Approx(2.5).epsilon(1e-3));
    CHECK(truth.object_id[middle] == 0);
    CHECK(truth.normal[middle].z > 0.99f);
    CHECK(length(places(truth, shot, shot.settings)[middle] - centre(middle)) < 1e-3);
}

}  // namespace dg
