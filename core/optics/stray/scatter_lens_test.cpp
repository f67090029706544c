#include "optics/stray/scatter_lens.h"

#include <doctest/doctest.h>

#include <cmath>

#include "math/error.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

ScatterLens make(const Prescription& lens, double iris_radius, const LensScatter& scatter) {
    const double film_z = lens.last_vertex() + lens.surfaces.back().thickness;
    return {lens, {{0, 0, film_z}}, Iris::polygon(6, 10, 0), iris_radius, {}, 20, scatter};
}

}  // namespace

TEST_CASE("walls run between the rims of the glass, and at the iris stay within its neighbours") {
    const Prescription lens = test::tessar();
    const ScatterLens scatter = make(lens, 2, {});
    const auto& rims = scatter.rims();
    const auto& vertices = scatter.ghosts().tracer().vertices();
    const int stop = scatter.ghosts().tracer().stop();
    REQUIRE(rims.size() == lens.surfaces.size());
    for (int i = 0; i < int(rims.size()); ++i) {
        CAPTURE(i);
        const Surface& s = lens.surfaces[std::size_t(i)];
        if (i != stop) CHECK(rims[i].radius == doctest::Approx(clear_radius(s)));
        const double c = s.curvature, r = rims[i].radius;   // all surfaces are spheres or planes
        CHECK(rims[i].z == doctest::Approx(vertices[i] + c * r * r / (1 + std::sqrt(1 - c * c * r * r))));
        if (i > 0) CHECK(rims[i].z >= rims[i - 1].z);
    }
    CHECK(rims[stop].radius >= clear_radius(lens.surfaces[std::size_t(stop)]));
    CHECK(rims[stop].radius <= std::max(rims[stop - 1].radius, rims[stop + 1].radius));
}

TEST_CASE("a lens scatters as soon as one of its parts does") {
    const Finish black{.diffuse = 0, .gloss = 0};
    CHECK_FALSE(LensScatter{black, black, 0}.scatters());
    CHECK(LensScatter{black, black, 1}.scatters());
    CHECK(LensScatter{{.diffuse = 0.03, .gloss = 0}, black, 0}.scatters());
    CHECK(LensScatter{black, {.diffuse = 0, .gloss = 0.1}, 0}.scatters());
}

TEST_CASE("lenses whose barrel is not known, and finishes that cannot be, are refused") {
    Prescription lens = test::tessar();
    lens.surfaces[2].decenter = {0.1, 0, 0};
    CHECK_THROWS_WITH_AS(make(lens, 4, {}), doctest::Contains("wanted a lens with axial symmetry"), Error);
    lens = test::tessar();
    lens.surfaces[2].semi_diameter = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(make(lens, 4, {}), doctest::Contains("surface 2: scatter: wanted a clear diameter"), Error);
    CHECK_THROWS_WITH_AS(make(test::tessar(), 4, {.surface_rms_nm = -1}), doctest::Contains("nm RMS"), Error);
    CHECK_THROWS_WITH_AS(make(test::tessar(), 4, {.barrel = {2, 0}}), doctest::Contains("barrel, diffuse"), Error);
}
