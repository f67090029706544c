#include "render/dispersion.h"

#include <doctest/doctest.h>

#include <map>

#include "math/hash.h"
#include "math/statistics.h"

namespace dg {
namespace {

/// Draws pixels for the near-by point as the film does, hands them to choose(), and holds the outcome
/// against the density of `px` itself.
double p_value(const Filter& filter, Vec2f px, Vec2f kept_px, double fault) {
    const FilmLayout region{8, 6, 2, 1, false};
    const FilmDensity density(filter, region);
    std::vector<Pixel> pixels;
    std::vector<double> kept_cdf{0}, expected, observed;
    const int n = 200000;
    for (int y = 1; y < 7; ++y)
        for (int x = 2; x < 10; ++x) {
            pixels.push_back({x, y});
            kept_cdf.push_back(kept_cdf.back() + density.of(kept_px, {x, y}) / density.total(kept_px));
            expected.push_back(n * density.of(px, {x, y}) / density.total(px));
        }
    observed.assign(pixels.size(), 0);
    for (int i = 0; i < n; ++i) {
        const double u = hash_uniform(1, i) * kept_cdf.back();
        const auto at = std::upper_bound(kept_cdf.begin() + 1, kept_cdf.end(), u) - kept_cdf.begin() - 1;
        const Pixel kept = pixels[std::min<std::size_t>(at, pixels.size() - 1)];
        const auto chosen = density.choose(px, kept_px, kept, float(hash_uniform(2, i)));
        REQUIRE(chosen.has_value());
        const int k = (chosen->y - 1) * 8 + chosen->x - 2;
        observed[k] += 1;
    }
    const auto largest = std::max_element(expected.begin(), expected.end());
    *largest *= 1 + fault;
    return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("the pixel of a reprojected wavelength follows the filter at its own film point") {
    for (const FilterKind kind :
         {FilterKind::gaussian, FilterKind::blackman_harris, FilterKind::mitchell}) {
        const Filter filter(kind);
        for (const Vec2f px : {Vec2f{5.3f, 3.6f}, Vec2f{5.9f, 3.2f}, Vec2f{2.1f, 1.2f}, Vec2f{9.7f, 6.8f}})
            CHECK(p_value(filter, px, {px.x * 0.97f + 0.2f, px.y * 0.95f + 0.15f}, 0) > 1e-4);
    }
    const Filter box(FilterKind::box);   // there only the pixel around the point remains
    const FilmLayout region{8, 6, 2, 1, false};
    const auto chosen = FilmDensity(box, region).choose({5.3f, 3.6f}, {6.2f, 3.6f}, {6, 3}, 0.5f);
    REQUIRE(chosen.has_value());
    CHECK(chosen->x == 5);
    CHECK_FALSE(FilmDensity(box, region).choose({1.9f, 3.6f}, {2.2f, 3.6f}, {2, 3}, 0.5f));
    CHECK(p_value(Filter(FilterKind::gaussian), {5.3f, 3.6f}, {5.6f, 3.4f}, 0.03) < 1e-6);
}

TEST_CASE("without dispersion all four wavelengths keep the pixel and the plain weight") {
    const Sensor sensor{8, 6, 8, 6, {0, 0}};
    const FilmLayout region{8, 6, 0, 0, false};
    for (const FilterKind kind : {FilterKind::box, FilterKind::mitchell}) {
        const Filter filter(kind);
        const FilmDensity density(filter, region);
        const Vec2f px{4.4f, 3.3f};
        const Hero hero{px, {4, 3}, 0.6f, 0.8f};
        const Reprojection same{sensor.mm_from_px(px), 0.75f, 0.8f};
        const std::array<Reprojection, 3> others{same, same, same};
        for (const Landing& l : land(density, sensor, hero, others, 0.999f)) {
            CHECK(l.pixel.x == 4);
            CHECK(l.pixel.y == 3);
            CHECK(l.weight == doctest::Approx(0.6 * filter.absolute_integral()).epsilon(1e-4));
        }
    }
}

TEST_CASE("a wavelength that the lens stops brings nothing and takes nothing") {
    const Sensor sensor{8, 6, 8, 6, {0, 0}};
    const FilmLayout region{8, 6, 0, 0, false};
    const Filter filter(FilterKind::box);
    const FilmDensity density(filter, region);
    const Hero hero{{4.4f, 3.3f}, {4, 3}, 0.8f, 0.8f};
    const auto landings = land(density, sensor, hero, std::array<Reprojection, 3>{}, 0.5f);
    // The ray could only have been drawn by the hero, one time in four.
    CHECK(landings[0].weight == doctest::Approx(4 * 0.8));
    for (int i = 1; i < kWavelengths; ++i) CHECK(landings[i].weight == 0);
}

}  // namespace dg
