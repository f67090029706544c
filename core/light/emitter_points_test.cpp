// Grouping of lights into sources that a lens sees in about one direction, and points of the sources.
#include "light/emitter_points.h"

#include <doctest/doctest.h>

#include <set>

#include "math/hash.h"

using namespace dg;

namespace {

constexpr float kRadius = 0.5f;

/// A disc that faces the z axis, a fan of `count` triangles.
std::vector<Light> disc(Vec3f middle, std::uint32_t triangles, std::uint32_t instance = 0) {
    std::vector<Light> lights;
    const auto rim = [&](std::uint32_t i) {
        const float angle = 2 * kPi * float(i) / float(triangles);
        return middle + Vec3f{std::cos(angle), std::sin(angle), 0} * kRadius;
    };
    for (std::uint32_t i = 0; i < triangles; ++i) {
        TriangleLight t{middle, rim(i), rim(i + 1), {5, 5, 5}, instance, i, false};
        t.even = true;
        lights.push_back(t);
    }
    return lights;
}

LightSet set_of(std::vector<Light> lights) { return LightSet(std::move(lights), std::nullopt); }

int sources_of(const LightSet& lights, std::vector<ViewCone> views = {{.from = {{0, 0, 0}, 0.02f}}}) {
    return EmitterPoints(lights, views).count();
}

}  // namespace

TEST_CASE("triangles of one instance are one source if they are seen as a small lamp") {
    CHECK(sources_of(set_of(disc({0, 0, -30}, 14))) == 1);
    CHECK(sources_of(set_of(disc({0, 0, -30}, 1000))) == 1);   // each triangle is weak
    CHECK(sources_of(set_of(disc({0, 0, -3}, 14))) == 14);     // near: triangles in different directions
    std::vector<Light> two = disc({0, 0, -30}, 14);
    for (const Light& l : disc({0.3f, 0, -30}, 20, 1)) two.push_back(l);
    CHECK(sources_of(set_of(two)) == 2);
    // A lens that comes near sees a large angular size.
    const ViewCone far{.from = {{0, 0, 0}, 0.02f}, .time = 0}, near{.from = {{0, 0, -27}, 0.02f}, .time = 1};
    CHECK(sources_of(set_of(disc({0, 0, -30}, 14)), {far, near}) == 14);
}

namespace {

/// Integral over the area of a source, and the lights of its points.
template <typename Of>
double integral(const EmitterPoints& sources, int source, const Viewpoint& view, const Of& of,
                std::set<std::int32_t>* drawn = nullptr) {
    constexpr int kDraws = 20000;
    double sum = 0;
    for (int i = 0; i < kDraws; ++i) {
        const Vec2f u{float(hash_uniform(1, i)), float(hash_uniform(2, i))};
        const auto p = sources.sample(source, float(hash_uniform(3, i)), u, 0.5f, view);
        if (!p) continue;
        sum += of(p->point.position) / double(p->point.pdf) / kDraws;
        if (drawn) drawn->insert(p->point.light);
    }
    return sum;
}

constexpr auto kArea = [](Vec3f) { return 1.0; };

/// A point 1 m in front of the lens.
TriangleLight wide() {
    TriangleLight t{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {5, 5, 5}, 0, 0, false};
    t.even = true;
    return t;
}

}  // namespace

TEST_CASE("points of a lamp of triangles are on all of it, and their densities add up to its area") {
    for (const std::uint32_t count : {14u, 300u}) {
        const LightSet lights = set_of(disc({0, 0, -30}, count));
        const ViewCone view{.from = {{0, 0, 0}, 0.02f}};
        const EmitterPoints sources(lights, std::span(&view, 1));
        std::set<std::int32_t> drawn;
        const double expected = 0.5 * count * std::sin(2 * kPiD / count) * kRadius * kRadius;
        CHECK(integral(sources, 0, view.from, kArea, &drawn) == doctest::Approx(expected).epsilon(1e-3));
        CHECK(drawn.size() == count);
        CHECK(sources.has_size(0));
    }
}

TEST_CASE("a light that is seen large is sources for its parts, which cover it once") {
    const ViewCone view{.from = {{0, 0, 0}, 0.02f}};
    for (const Light& light : {Light(wide()), Light(SphereLight{{{0, 0, -2}, 1}, {5, 5, 5}})}) {
        const LightSet lights = set_of({light});
        const EmitterPoints sources(lights, std::span(&view, 1));
        REQUIRE(sources.count() > 9);
        double area = 0, strength = 0, xx = 0, xy = 0;
        for (int i = 0; i < sources.count(); ++i) {
            area += integral(sources, i, view.from, kArea), strength += sources.strength(i);
            xx += integral(sources, i, view.from, [](Vec3f p) { return double(p.x) * p.x; });
            xy += integral(sources, i, view.from, [](Vec3f p) { return double(p.x) * p.y; });
            CHECK(sources.strength(i) > 0);
        }
        const bool flat = std::holds_alternative<TriangleLight>(light);
        // Area of a ball that points of the lens may see: 2 pi r^2 (1 - cos).
        const double seen = 2 * kPiD * (1 - (1 - 0.02) / 2);
        CHECK(area == doctest::Approx(flat ? 2 : seen).epsilon(0.02));
        if (flat) CHECK(xx == doctest::Approx(2 / 3.0).epsilon(0.02));
        CHECK(std::abs(xy) < 0.02);
        CHECK(strength == doctest::Approx(illuminance_estimate(lights.bounds_of(0), false, view)).epsilon(0.1));
    }
}

TEST_CASE("a large light that is dim beside others stays whole: each part has to be learned about") {
    const ViewCone view{.from = {{0, 0, 0}, 0.02f}};
    const double own = illuminance_estimate(set_of({wide()}).bounds_of(0), false, view);
    const auto beside = [&](double times) {   // a ball with a multiple of its light
        const float luminance = float(times * own / (kPiD * 0.01 * 0.01));
        return sources_of(set_of({wide(), SphereLight{{{0, 0, -1}, 0.01f}, {luminance, luminance, luminance}}}));
    };
    CHECK(beside(60) == 2);
    CHECK(beside(10) > 10);
}
