// Ghosts of small sources drawn from maps are those that exact paths find, map alone and with what rays take off it.
#include "render/flare/maps/sheet_pass.h"

#include <doctest/doctest.h>

#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

/// A frame that is large enough for the sun's ghosts to have a shape.
constexpr int kWide = 160, kHigh = 120, kSide = 20;

RenderSettings wide_settings(std::uint64_t seed, double paths, bool maps) {
    RenderSettings s = settings(seed, paths);
    s.sensor = {kWide, kHigh, kSensorWidth, kSensorHeight, {0, 0}};
    s.filter = Filter();
    s.flare.maps = maps;
    return s;
}

/// Means of blocks, of X, Y and Z.
std::vector<double> blocks_of(const std::vector<float>& xyz) {
    constexpr int kAcross = kWide / kSide;
    std::vector<double> blocks(3 * std::size_t(kAcross) * (kHigh / kSide));
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x)
            for (int c = 0; c < 3; ++c)
                blocks[3 * std::size_t(y / kSide * kAcross + x / kSide) + c] +=
                    xyz[3 * (std::size_t(y) * kWide + x) + c] / (kSide * kSide);
    return blocks;
}

Blocks pictures(const Scene& scene, const Camera& camera, int count, double paths, bool maps) {
    Blocks all;
    RenderSettings s = wide_settings(0, paths, maps);
    s.flare.guide = std::make_shared<const FlareGuide>(std::make_shared<const FlareAim>(scene, camera, s), s);
    CHECK(s.flare.guide->sheets().empty() == !maps);
    for (int k = 0; k < count; ++k) {
        s.seed = std::uint64_t(k) + 1;
        Film film(FilmLayout{.width = kWide, .height = kHigh, .flare = true});
        draw_flare(scene, camera, film, s);
        all.push_back(blocks_of(film.flare_xyz()));
    }
    return all;
}

}  // namespace

TEST_CASE("ghosts of the sun from maps are those from paths, in every channel and block") {
    const auto scene = sunny();
    for (const Prescription& lens : {test::tessar(), test::wide_angle(), test::telephoto()}) {
        const Camera camera = camera_with(lens);
        const Blocks maps = pictures(*scene, camera, 6, 20000, true), paths = pictures(*scene, camera, 6, 400000, false);
        INFO(lens.name << ": from maps " << show(maps) << ", from paths " << show(paths));
        CHECK(whole(paths).mean > 0);
        CHECK(equality(maps, paths) > 1e-3);
    }
}

TEST_CASE("maps have the same bits on any number of threads, and ranges of samples add") {
    const auto scene = sunny();
    const Camera camera = camera_with(test::tessar());
    const auto drawn = [&](int threads, std::uint32_t begin, std::uint32_t end, Film& film) {
        RenderSettings s = wide_settings(3, 5001.3, true);
        s.threads = threads, s.sample_begin = begin, s.sample_end = end;
        draw_flare(*scene, camera, film, s);
    };
    const FilmLayout layout{.width = kWide, .height = kHigh, .flare = true};
    check_same_bits(layout, drawn);
    Film one(layout);
    drawn(1, 0, 5, one);
    const FilmLayout part{.width = 40, .height = 30, .offset_x = 60, .offset_y = 50, .flare = true};
    Film crop(part);
    drawn(2, 0, 5, crop);
    const std::vector<float> all = one.flare_xyz(), own = crop.flare_xyz();
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            CHECK(own[3 * (std::size_t(y) * part.width + x) + 1] ==
                  all[3 * (std::size_t(y + part.offset_y) * kWide + x + part.offset_x) + 1]);
}
