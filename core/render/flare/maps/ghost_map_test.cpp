// Maps of ghosts against exact rays, at front points and wavelengths between their nodes.
#include "render/flare/maps/ghost_map.h"

#include <doctest/doctest.h>

#include <cmath>

#include "render/flare/flare_scenes.h"
#include "render/flare/maps/coarse_light.h"
#include "render/flare/maps/color_table.h"
#include "render/flare/maps/sheet_pieces.h"

using namespace dg;

namespace {

constexpr int kRays = 64;   // per cell

/// Light of maps and rays at the same front points, and the distance of their landings.
struct Compared {
    double map = 0, rays = 0, wrong = 0, apart = 0, lit = 0, cells = 0;
};

void compare(const GhostMap& map, const MapRays& rays, const SmallSource& source, Compared& to) {
    MapBatch batch{};
    CellNumbers u;
    for (std::uint32_t c = 0; c < map.cells().size(); ++c) {
        const GhostMap::Cell& cell = map.cells()[c];
        if (cell.exact) continue;
        const SheetPiece whole{c, {0, 0}, 1, 0};
        u.fill(hash64(7, std::uint64_t(to.cells++)), 0, kRays);
        draw_places(batch, whole, source, u, kRays);
        map.landings(cell, batch, kRays);
        const std::vector<MapLanding> landings = rays.trace(rays_of(map, cell, batch, kRays));
        const double each = area(map, whole);
        for (int i = 0; i < kRays; ++i) {
            const double light = each * seen_light(batch.nm[i]), own = rays.passed(landings[i], 1);
            to.map += light * batch.pass[i], to.rays += light * own;
            to.wrong += light * std::abs(batch.pass[i] - own);
            if (!(own > 0 && batch.pass[i] > 0)) continue;
            const float blur = std::max(1.f, cell.blur.light);   // px
            to.apart += light * own * double(length(landings[i].px - Vec2f{batch.x[i], batch.y[i]}) / blur);
            to.lit += light * own;
        }
    }
}

}  // namespace

TEST_CASE("maps have the light of rays, and land it where rays do") {
    const auto scene = sunny();
    for (const Prescription& lens : {test::tessar(), test::wide_angle(), test::telephoto()}) {
        const Camera camera = camera_with(lens);
        const RenderSettings s = settings(1, 1);
        const FlareAim aim(*scene, camera, s);
        const auto source = small_source(aim, 0);
        REQUIRE(source);
        CHECK(source->filled == doctest::Approx(1).epsilon(0.15));   // a uniform disc
        Compared all;
        for (int ghost = 0; ghost < aim.pairs(); ++ghost) {
            const MapRays rays(camera, aim.sensor(), aim.ghost_lens(), aim.steps(ghost), source->shape);
            compare(GhostMap(rays, aim.sensor(), CoarseLight::reach(4), {}), rays, *source, all);
        }
        INFO(lens.name << ": " << all.cells << " cells, map / rays " << all.map / all.rays << ", wrong "
                       << all.wrong / all.rays << ", apart " << all.apart / all.lit);
        CHECK(all.cells > 100);
        CHECK(all.map == doctest::Approx(all.rays).epsilon(0.005));
        CHECK(all.wrong < 0.03 * all.rays);
        CHECK(all.apart < 0.02 * all.lit);
    }
}
