#include "render/truth/ray_map.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "optics/lens/test_lenses.h"

namespace dg {
namespace {

const Sensor kSensor{12, 8, 36, 24, {1, -2}};

PixelRays map_of(const LensKind& lens, const FilmLayout& region, RayFrame frame = RayFrame::camera) {
    Affine3d pose;
    pose.origin = {1, 2, 3};
    const Shutter shutter({0, {}, ScanOrder::top, 1e-3}, kSensor.width, kSensor.height);
    return ray_map(Camera{pose, lens}, kSensor, shutter, region, frame, 1);
}

}  // namespace

TEST_CASE("a ray goes through its pixel's middle, at the time of its line, in either frame") {
    const FilmLayout region{14, 9, -1, 0};
    const PixelRays own = map_of(Pinhole{50, false}, region);
    const PixelRays world = map_of(Pinhole{50, false}, region, RayFrame::world);
    for (int y = 0; y < region.height; ++y)
        for (int x = 0; x < region.width; ++x) {
            const std::size_t i = std::size_t(y) * region.width + x;
            const Vec2d film = kSensor.mm_from_px(Vec2d{x - 0.5, y + 0.5});
            CHECK(length(own.directions[i] - normalize(Vec3d{film.x, film.y, -50})) < 1e-12);
            CHECK(own.times[i] == doctest::Approx(std::min(y, 7) / 7.0));
            CHECK(length(own.origins[i]) == 0);
            CHECK(length(world.origins[i] - Vec3d{1, 2, 3}) < 1e-12);
        }
}

TEST_CASE("where no light comes there is no ray") {
    const ExactLens lens(test::tessar(), {4, {}, 2, FocusFrom::pupil, 60});
    const PixelRays map = map_of(lens, {40, 1, -14, 4});
    CHECK(std::isnan(map.directions.front().x));
    CHECK(std::isnan(map.origins.back().z));
    CHECK(std::isfinite(map.directions[20].x));
    const ChiefRays chief(lens);
    for (double r = 0; r < 60; r += 0.7) {   // compares with traced samples
        const Camera camera{Affine3d{}, lens};
        std::vector<CameraSample> samples;
        for (int k = 0; k < 4096; ++k)
            samples.push_back({{float(r), 0}, {(k % 64 + 0.5f) / 64, (k / 64 + 0.5f) / 64}, 0, 587.56f});
        std::vector<CameraRay> rays(samples.size());
        generate_rays(camera, samples, rays);
        const auto passed = std::ranges::count_if(rays, [](const CameraRay& ray) { return ray.weight > 0; });
        if (passed == 0 || passed > 60) CHECK(sees(camera, chief, {r, 0}, 0) == (passed > 0));
    }
}

}  // namespace dg
