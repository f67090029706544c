// bounds_test.cpp -- pairs of boxes against all pairs; distances of triangles against dense points of them.
#include <doctest/doctest.h>

#include <random>
#include <set>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/triangle_distance.h"

using namespace dg;

namespace {

struct Boxed {
    Bounds bounds;
    int index;
};

std::vector<Boxed> boxes(int count, std::mt19937& random, float size) {
    std::uniform_real_distribution<float> place(0, 1), width(0, size);
    std::vector<Boxed> made;
    for (int i = 0; i < count; ++i) {
        const Vec3f min{place(random), place(random), place(random)};
        made.push_back({{min, min + Vec3f{width(random), width(random), width(random)}}, i});
    }
    return made;
}

using Pairs = std::set<std::pair<int, int>>;

Triangle3d triangle(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1, 1);
    Triangle3d t;
    for (Vec3d& p : t) p = {place(random), place(random), place(random)};
    return t;
}

/// The least distance between points of two triangles, on a lattice.
double by_points(const Triangle3d& a, const Triangle3d& b, int n) {
    double least = 1e9;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; i + k <= n; ++k)
            least = std::min(least, distance(a[0] + (a[1] - a[0]) * (double(i) / n) + (a[2] - a[0]) * (double(k) / n), b));
    return least;
}

}  // namespace

TEST_CASE("pairs of boxes that meet are found once each") {
    std::mt19937 random(1);
    for (const int count : {0, 1, 7, 9, 300}) {
        std::vector<Boxed> as = boxes(count, random, 0.2f), bs = boxes(2 * count, random, 0.1f);
        Pairs want, got, want_own, got_own;
        for (const Boxed& a : as)
            for (const Boxed& b : bs)
                if (a.bounds.meets(b.bounds)) want.emplace(a.index, b.index);
        for (const Boxed& a : as)
            for (const Boxed& b : as)
                if (a.index < b.index && a.bounds.meets(b.bounds)) want_own.emplace(a.index, b.index);
        CHECK(each_meeting(std::span(as), std::span(bs), [&](const Boxed& a, const Boxed& b) {
            return got.emplace(a.index, b.index).second;
        }));
        CHECK(each_meeting(std::span(as), [&](const Boxed& a, const Boxed& b) {
            return got_own.emplace(std::minmax(a.index, b.index)).second;
        }));
        CHECK(got == want);
        CHECK(got_own == want_own);
        if (count == 300) CHECK(want_own.size() > 50);
    }
}

TEST_CASE("a search for pairs ends where its use says so") {
    std::mt19937 random(2);
    std::vector<Boxed> all = boxes(200, random, 0.5f);
    int calls = 0;
    CHECK_FALSE(each_meeting(std::span(all), [&](const Boxed&, const Boxed&) { return ++calls < 3; }));
    CHECK(calls == 3);
}

TEST_CASE("the distance of a point from a triangle is that from its face, edge or corner") {
    const Triangle3d t{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
    CHECK(distance(Vec3d{0.5, 0.5, -3}, t) == doctest::Approx(3));
    CHECK(distance(Vec3d{1, -2, 0}, t) == doctest::Approx(2));
    CHECK(distance(Vec3d{-3, -4, 0}, t) == doctest::Approx(5));
    CHECK(distance(Vec3d{2, 2, 0}, t) == doctest::Approx(std::sqrt(2.0)));
    CHECK(distance(Vec3d{0, 3, 0}, Triangle3d{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}) == doctest::Approx(3));   // no area
}

TEST_CASE("the distance of triangles agrees with points on them") {
    std::mt19937 random(3);
    int apart = 0, pierced = 0;
    for (int i = 0; i < 300; ++i) {
        const Triangle3d a = triangle(random), b = triangle(random);
        const double found = distance(a, b), points = std::min(by_points(a, b, 40), by_points(b, a, 40));
        CHECK(found == doctest::Approx(distance(b, a)).epsilon(1e-9));
        CHECK(found <= points + 1e-9);
        CHECK(found >= points - 0.06);   // the lattice's spacing
        found > 0 ? ++apart : ++pierced;
    }
    CHECK(apart > 50);
    CHECK(pierced > 50);
}
