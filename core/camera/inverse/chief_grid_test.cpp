// Chief rays on the film's grid against chief rays by film radius, and their inverse.
#include "camera/inverse/chief_grid.h"

#include <doctest/doctest.h>

#include "camera/inverse/chief.h"
#include "math/hash.h"
#include "optics/lens/test_lenses.h"

namespace dg {
namespace {

constexpr double kPixelMm = 0.006;

ExactLens tessar(double metres) {
    ExactLensSettings settings;
    settings.f_stop = 4, settings.focus_distance_m = metres;
    return {test::tessar(), settings};
}

Vec2d somewhere(int i, Vec2d half) {
    return {half.x * (2 * hash_uniform(1, i) - 1), half.y * (2 * hash_uniform(2, i) - 1)};
}

}  // namespace

TEST_CASE("of a lens that is the same on all sides the grid has the rays of the radius") {
    const ExactLens lens = tessar(2);
    const ChiefRays by_radius{LensKind(lens)};
    const ChiefGrid grid(lens);
    for (int i = 0; i < 100; ++i) {
        const Vec2d film = somewhere(i, {14, 12});
        const auto line = grid.at(film);
        const ChiefRay expected = by_radius.at(film);
        CHECK(length(line.direction - expected.direction) < 2e-5);
        const Vec3d off = line.foot - expected.origin;
        CHECK(length(off - expected.direction * dot(off, expected.direction)) < 2e-5);
        const Vec3d point = expected.origin + expected.direction * 2.0;
        const auto back = grid.film_point(point, 1);
        REQUIRE(back);
        CHECK(length(*back - film) < 2e-3);
    }
}

TEST_CASE("film point of chief ray of film point is the film point, to 1e-3 px") {
    const ChiefGrid grid(tessar(2));
    for (const double distance : {0.3, 2.0, 1e4})
        for (int i = 0; i < 100; ++i) {
            const Vec2d film = somewhere(i, {18, 12});
            const auto line = grid.at(film);
            const Vec3d p = line.foot + line.direction * (distance + line.start);
            const auto back = grid.film_point(p, 1), slipped = grid.film_point(p + Vec3d{1e-6 * distance, 0, 0}, 1);
            REQUIRE(back);
            CHECK(length(*back - film) < 1e-3 * kPixelMm);
            CHECK(length(*slipped - film) > 1e-3 * kPixelMm);   // planted fault
        }
}

TEST_CASE("what lies behind has no film point, what lies far has that of its direction") {
    const ChiefGrid grid(tessar(2));
    CHECK(!grid.film_point({0.1, 0.2, 1}, 1));
    CHECK(!grid.film_point({0.3, -0.2, 1}, 0));
    const auto line = grid.at({10, -7});
    CHECK(length(*grid.film_point(line.direction, 0) - Vec2d{10, -7}) < 1e-6);
}

}  // namespace dg
