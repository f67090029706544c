#include "optics/expansion/system.h"

#include <doctest/doctest.h>

#include <cmath>

#include "math/error.h"
#include "optics/expansion/elements.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

LensWay way_through(const Tracer& tracer) {
    return {straight_path(int(tracer.prescription().surfaces.size()), true),
            0,
            first_order(tracer.prescription()).back_focal_z,
            false,
            {}};
}

double gap(const RayMap& a, const RayMap& b, const RayNumbers& ray) {
    const RayNumbers p = a.evaluate(ray), q = b.evaluate(ray);
    return std::hypot(p[0] - q[0], p[1] - q[1]);
}

}  // namespace

TEST_CASE(
    "between nodes the coefficients follow the wavelength, the better the more nodes") {
    const Tracer tracer(test::tessar());
    const LensWay way = way_through(tracer);
    const RayNumbers ray{3, 1, 0.1, -0.05};
    double before = 1;
    for (const int count : {2, 3, 4, 6}) {
        const PolynomialSystem system =
            lens_system(tracer, way, wavelength_nodes(400, 700, count), 5);
        double worst = 0;
        for (double nm = 405; nm < 700; nm += 10)
            worst = std::max(
                worst, gap(system.at(nm), lens_map(tracer, tracer.at(nm), way, 5), ray));
        CHECK(worst < 0.1 * before);
        before = worst;
    }
    CHECK(before < 1e-6);  // mm
}

TEST_CASE("composition is exact at the nodes, and an element without any goes with all") {
    const Tracer tracer(test::tessar());
    const std::vector<double> nm = wavelength_nodes(400, 700, 3);
    const LensWay way = way_through(tracer);
    LensWay further = way;
    further.start_z -= 2, further.end_z += 3;
    const PolynomialSystem whole = lens_system(tracer, further, nm, 5);
    const PolynomialSystem parts =
        compose({{}, {propagation(3, 5)}},
                compose(lens_system(tracer, way, nm, 5), {{}, {propagation(2, 5)}}));
    for (std::size_t i = 0; i < nm.size(); ++i)
        CHECK(gap(whole.maps[i], parts.maps[i], {2, -1, 0.05, 0.1}) < 1e-12);
    const PolynomialSystem there = compose(inverse(whole), whole);
    CHECK(gap(there.maps[2], propagation(0, 5), {0.1, 0.1, 0.01, 0.01}) < 1e-10);
    CHECK(truncated(whole, 3).degree() == 3);
}

TEST_CASE("wavelengths that a system does not have") {
    const Tracer tracer(test::tessar());
    const LensWay way = way_through(tracer);
    const PolynomialSystem one = lens_system(tracer, way, {550}, 1);
    CHECK_THROWS_WITH_AS(one.at(551), doctest::Contains("for which it was made"), Error);
    const PolynomialSystem two = lens_system(tracer, way, {450, 650}, 1);
    CHECK_THROWS_WITH_AS(two.at(700), doctest::Contains("between 450, 650"), Error);
    CHECK_THROWS_WITH_AS(compose(one, two), doctest::Contains("same wavelengths"), Error);
    CHECK_THROWS_WITH_AS(lens_system(tracer, way, {650, 450}, 1),
                         doctest::Contains("ascending"), Error);
}
