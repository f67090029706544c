// Bounding boxes and silhouettes of objects, against closed forms and dense points.
#include "render/truth/truth_objects.h"

#include <doctest/doctest.h>

#include "camera/inverse/chief.h"
#include "math/quaternion.h"
#include "scene/test_scenes.h"

namespace dg {
namespace {

const Sensor kSensor{40, 30, 36, 27};  // px of 0.9 mm
const FilmLayout kAll{kSensor.width, kSensor.height, 0, 0};
constexpr double kPixels = 50 / 0.9;   // film distance of the 50 mm lens, px

/// A square of half side `half`, rotated about x by `degrees`.
Affine3f square(double half, Vec3d origin, double degrees = 0) {
    const Affine3d turn =
        to_matrix(Quaterniond::from_axis_angle({1, 0, 0}, degrees * kPiD / 180));
    const Vec3d scaled = half * Vec3d{1, 1, 1};
    return {to_float(turn.x * scaled.x), to_float(turn.y * scaled.y), to_float(turn.z * scaled.z),
            to_float(origin)};
}

struct World {
    std::vector<Affine3f> squares;
    LensKind lens = Pinhole{50, false};
    ShutterSettings shutter{};
    Vec3d per_second{0, 0, 0};   // velocity of the first square

    struct Shot {
        std::shared_ptr<const Scene> scene;
        Camera camera;
        RenderSettings settings;
        operator TruthFrame() const { return {*scene, camera}; }
    };
    Shot shot() const {
        SceneDescription d = describe(quad_mesh(), GltfMaterial{});
        d.instances.resize(squares.size(), d.instances[0]);
        for (std::size_t i = 0; i < squares.size(); ++i)
            d.instances[i].world_from_local = squares[i];
        Shot made{nullptr, {Motion(Affine3d{}), lens}, RenderSettings()};
        made.settings.sensor = kSensor;
        made.settings.shutter = Shutter(shutter, kSensor.width, kSensor.height);
        d.interval = {0, made.settings.shutter.duration_s()};
        if (length(per_second) > 0) {
            Affine3d a = to_double(squares[0]), b = a;
            b.origin = b.origin + per_second;
            const std::array times{0.0, 1.0};
            const std::array keys{a, b};
            d.instances[0].motion = std::make_shared<const Motion>(
                Motion::keys(times, keys, Interpolation::linear));
        }
        made.scene = Scene::build(std::move(d));
        return made;
    }
    GroupOutline outline() const {
        const Shot made = shot();
        const std::vector<std::uint32_t> groups(squares.size(), 0);
        return outlines(made, made.settings, groups, 1)[0];
    }
};

void check_box(const GroupOutline& o, double x0, double y0, double x1, double y1, double within) {
    CHECK(std::abs(o.low.x - x0) < within);
    CHECK(std::abs(o.low.y - y0) < within);
    CHECK(std::abs(o.high.x - x1) < within);
    CHECK(std::abs(o.high.y - y1) < within);
}

}  // namespace

TEST_CASE("a square before a pinhole, and one that leaves the frame") {
    const double side = kPixels / 4;
    const GroupOutline o = World{{square(0.5, {0, 0, -4})}}.outline();
    CHECK(!o.open);
    check_box(o, 20 - side / 2, 15 - side / 2, 20 + side / 2, 15 + side / 2, 1e-4);
    const GroupOutline left = World{{square(0.5, {-3, 0, -4})}}.outline();
    check_box(left, 20 - 3.5 * side, 15 - side / 2, 20 - 2.5 * side, 15 + side / 2, 1e-4);
    const GroupOutline both = World{{square(0.5, {0, 0, -4}), square(0.5, {-3, 0, -4})}}.outline();
    check_box(both, 20 - 3.5 * side, 15 - side / 2, 20 + side / 2, 15 + side / 2, 1e-4);
}

TEST_CASE("a floor that begins behind the camera: open, up to its far edge, and down beyond all") {
    const GroupOutline o = World{{square(5, {0, -1, 0}, -90)}}.outline();
    CHECK(o.open);
    CHECK(o.low.y == doctest::Approx(15 + kPixels / 5).epsilon(1e-6));
    CHECK(o.high.y > 1e4);
    CHECK(o.low.x < -1e4);
    CHECK(o.high.x > 1e4);
    const GroupOutline behind = World{{square(0.5, {0, 0, 4})}}.outline();
    CHECK(behind.empty);
    CHECK(behind.open);
}

TEST_CASE("edges that a fisheye bends reach as far as their points") {
    const Projection fisheye{ProjectionModel(ProjectionModel::Kind::equidistant), {14, 14}};
    World world{{square(2, {0.7, 0.3, -1.5})}, fisheye};
    const World::Shot shot = world.shot();
    GroupOutline dense{{1e9, 1e9}, {-1e9, -1e9}};
    for (int i = 0; i <= 200; ++i)
        for (int j = 0; j <= 200; ++j) {
            const Vec3d p{0.7 + 2 * (i / 100.0 - 1), 0.3 + 2 * (j / 100.0 - 1), -1.5};
            const Vec2d px = kSensor.px_from_mm(*fisheye.film_point(p, 1));
            dense.low = {std::min(dense.low.x, px.x), std::min(dense.low.y, px.y)};
            dense.high = {std::max(dense.high.x, px.x), std::max(dense.high.y, px.y)};
        }
    const GroupOutline o = world.outline();
    CHECK(!o.open);
    check_box(o, dense.low.x, dense.low.y, dense.high.x, dense.high.y, 0.06);
    const Vec2d corner = kSensor.px_from_mm(*fisheye.film_point({-1.3, 2.3, -1.5}, 1));
    CHECK(corner.x - dense.low.x > 1);   // planted fault: corners alone
    CHECK(corner.y - dense.low.y > 1);
}

TEST_CASE("a rolling shutter: each point at the moment of the line on which it lands") {
    World world{{square(0.5, {0, 0, -4})}};
    world.shutter = {0, OpeningCurve(), ScanOrder::top, 1e-3};
    world.per_second = {8, 0, 0};
    const double side = kPixels / 4, per_line = 8 * 1e-3 * kPixels / 4;
    // Rows of the top and bottom edges; line i opens (i - 0.5) line times after the first.
    const double top = (15 - side / 2 - 0.5) * per_line, end = (15 + side / 2 - 0.5) * per_line;
    check_box(world.outline(), 20 - side / 2 + top, 15 - side / 2, 20 + side / 2 + end,
              15 + side / 2, 1e-3);
    CHECK(end - top > 1);   // planted fault: one time for all lines
}

TEST_CASE("silhouettes: what is hidden counts for the whole, and what hides for nobody else") {
    // The near square covers the lower left quarter of the far square; edges have margins of half a pixel.
    const double px = 4 / kPixels;   // m at z = -4
    World world{{square(6 * px, {0, 0, -4}), square(4 * px, {-4 * px, -4 * px, -4})}};
    for (float* v : {&world.squares[1].origin.x, &world.squares[1].origin.y,
                     &world.squares[1].origin.z})
        *v *= 0.5f;
    world.squares[1].x = world.squares[1].x * 0.5f, world.squares[1].y = world.squares[1].y * 0.5f;
    const World::Shot shot = world.shot();
    const std::array<std::uint32_t, 2> groups{0, 1};
    const auto s = silhouettes(shot, kAll, shot.settings, groups, 2);
    CHECK(s[0].whole == 144);
    CHECK(s[0].visible == 144 - 36);
    CHECK(s[0].x0 == 14);
    CHECK(s[0].y0 == 9);
    CHECK(s[0].x1 == 26);
    CHECK(s[0].y1 == 21);
    CHECK(s[1].whole == 64);
    CHECK(s[1].visible == 64);
    const std::array<std::uint32_t, 2> one{0, kNoGroup};
    const auto alone = silhouettes(shot, kAll, shot.settings, one, 1);
    CHECK(alone[0].whole == 144);
    CHECK(alone[0].visible == 144 - 36);
    const std::array<std::uint32_t, 2> same{0, 0};
    CHECK(silhouettes(shot, kAll, shot.settings, same, 1)[0].whole == 144 + 64 - 36);
}

}  // namespace dg
