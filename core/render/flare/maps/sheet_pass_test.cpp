// Ghosts of small sources drawn from maps are those that exact paths find, map alone and with what rays take off it.
#include "render/flare/maps/sheet_pass.h"

#include <doctest/doctest.h>

#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

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
        const Blocks maps = pictures(*scene, camera, 6, 40000, true), paths = pictures(*scene, camera, 6, 800000, false);
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
    check_same_bits({.width = kWide, .height = kHigh, .flare = true}, drawn);
    check_crop(drawn);
}
