// ray_cone_test.cpp -- ray cones against paraxial formulas from textbooks.
#include "geometry/ray_cone.h"

#include <doctest/doctest.h>

namespace dg {

TEST_CASE("a cone grows along the ray, and one of no width stays so") {
    const RayCone cone{0.01f, 0.002f};
    CHECK(cone.after(5).width == doctest::Approx(0.02));
    CHECK(cone.after(5).spread == cone.spread);
    CHECK(RayCone{}.empty());
    CHECK(RayCone{}.after(1000).empty());
}

TEST_CASE("mirrors: a plane keeps the cone, a hollow one of radius R has its focus at R / 2") {
    const RayCone cone{0.01f, 0.002f};
    CHECK(cone.reflected(0).spread == cone.spread);
    const float radius = 0.4f;
    const RayCone parallel{0.01f, 0};
    CHECK(std::abs(parallel.reflected(-1 / radius).after(radius / 2).width) < 1e-7f);
    CHECK(parallel.reflected(1 / radius).after(radius / 2).width == doctest::Approx(0.02));
}

TEST_CASE("glass: a plane divides the spread by n, a surface of radius R has f = n R / (n - 1)") {
    const float n = 1.5f, radius = 0.03f;
    CHECK(RayCone{0, 0.003f}.refracted(0, n).spread == doctest::Approx(0.002));
    const RayCone inside = RayCone{0.001f, 0}.refracted(1 / radius, n);
    CHECK(std::abs(inside.after(n * radius / (n - 1)).width) < 1e-8f);
    // Ball of n = 1.5: from its centre to its focus n R / (2 (n - 1)).
    const RayCone out = inside.after(2 * radius).refracted(-1 / radius, 1 / n);
    CHECK(std::abs(out.after(n * radius / (2 * (n - 1)) - radius).width) < 1e-8f);
}

TEST_CASE("scattering widens, the more the less likely the direction") {
    const RayCone beyond_focus{-0.01f, -0.002f};
    const RayCone diffuse = beyond_focus.scattered(0.3f), sharp = beyond_focus.scattered(3000);
    CHECK(diffuse.width == doctest::Approx(0.01));
    CHECK(diffuse.spread - 0.002f == doctest::Approx(100 * (sharp.spread - 0.002f)));
    CHECK(sharp.spread > 0.002f);
}

}  // namespace dg
