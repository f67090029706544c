// motion_test.cpp -- interpolated transforms against closed forms.
#include "motion/motion.h"

#include <doctest/doctest.h>

#include <array>

#include "math/error.h"

namespace dg {
namespace {

constexpr std::array kAll{Interpolation::linear, Interpolation::twist, Interpolation::slerp,
                          Interpolation::decomposed};

Affine3d turned(Vec3d axis, double degrees, Vec3d origin = {}) {
    Affine3d m = to_matrix(Quaterniond::from_axis_angle(axis, degrees * kPiD / 180));
    m.origin = origin;
    return m;
}

Motion between(const Affine3d& a, const Affine3d& b, Interpolation how, Vec3d pivot = {}) {
    const std::array times{0.0, 1.0};
    const std::array keys{a, b};
    return Motion::keys(times, keys, how, pivot);
}

double apart(Vec3d a, Vec3d b) { return length(a - b); }

TEST_CASE("every interpolation meets its keys and holds them outside") {
    const Affine3d a = turned({0, 0, 1}, 20, {1, 2, 3}), b = turned({0, 1, 0}, 70, {4, 5, 6});
    const Vec3d p{0.3, -0.7, 0.9};
    for (const Interpolation how : kAll) {
        const Motion m = between(a, b, how);
        CHECK(apart(m.at(0).point(p), a.point(p)) < 1e-12);
        CHECK(apart(m.at(1).point(p), b.point(p)) < 1e-12);
        CHECK(apart(m.at(-3).point(p), a.point(p)) < 1e-12);
        CHECK(apart(m.at(9).point(p), b.point(p)) < 1e-12);
    }
}

TEST_CASE("other origins of the world and the local space leave every point where it was") {
    const Affine3d a = turned({0, 0, 1}, 20, {1, 2, 3}), b = turned({0, 1, 0}, 70, {4, 5, 6});
    const Vec3d p{0.3, -0.7, 0.9}, world{512000, 1024, -5399552}, local{1024, 0, -2048};
    for (const Interpolation how : kAll) {
        const Motion still = between(a, b, how, {0.5, 0, 1});
        for (const Motion& m : {still, still.spinning({{0, 1, 1}, 3, {0.25, 0, 0}, 0.1})}) {
            const Motion moved = m.relative_to(world, local);
            for (const double t : {-1.0, 0.0, 0.3, 0.5, 1.0, 2.0})
                CHECK(apart(moved.at(t).point(p - local), m.at(t).point(p) - world) < 1e-8);
        }
    }
}

TEST_CASE("a turn: constant speed, and linear shrinks by cos(angle / 2) at mid-time") {
    for (const double degrees : {1.0, 10.0, 21.0, 45.0, 170.0, 180.0}) {
        CAPTURE(degrees);
        const Affine3d b = turned({0, 0, 1}, degrees);
        const Affine3d third = turned({0, 0, 1}, degrees / 3);
        for (const Interpolation how : {Interpolation::twist, Interpolation::slerp, Interpolation::decomposed}) {
            const Vec3d p = between({}, b, how).at(1.0 / 3).point({1, 0, 0});
            CHECK(apart(p, third.point({1, 0, 0})) < 1e-12);
        }
        const Vec3d p = between({}, b, Interpolation::linear).at(0.5).point({1, 0, 0});
        CHECK(length(p) == doctest::Approx(std::cos(degrees * kPiD / 360)).epsilon(1e-9));
    }
}

TEST_CASE("decomposed keeps mirror and shear") {
    Affine3d a{{-2, 0, 0}, {0.5, 1, 0}, {0, 0, 3}, {1, 0, 0}};   // mirrored, sheared
    const Affine3d b = turned({0, 0, 1}, 170) * a;
    const Motion m = between(a, b, Interpolation::decomposed);
    // b = turn a: the stretch is constant and the rotation is the turn.
    const Affine3d expected = turned({0, 0, 1}, 85);
    const Vec3d p{0.2, 0.4, 0.6};
    const Vec3d around = m.at(0.5).vector(p);
    CHECK(apart(around, expected.vector(a.vector(p))) < 1e-9);
    CHECK(m.at(0.5).determinant() == doctest::Approx(a.determinant()).epsilon(1e-9));
}

TEST_CASE("the pivot goes straight, and what turns about it keeps its distance") {
    const Vec3d pivot{3, 0, 0};
    const Affine3d a{}, b = turned({0, 0, 1}, 90, {5, 1, 0});
    const Motion m = between(a, b, Interpolation::decomposed, pivot);
    const Vec3d middle = (a.point(pivot) + b.point(pivot)) * 0.5;
    CHECK(apart(m.at(0.5).point(pivot), middle) < 1e-12);
    CHECK(length(m.at(0.5).point({4, 0, 0}) - middle) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("a spin turns any number of times, about its centre") {
    const Motion m = Motion(turned({1, 0, 0}, 30, {0, 7, 0}))
                         .spinning({{0, 0, 2}, 100.25, {1, 0, 0}, 0});
    CHECK(m.moves());
    CHECK(apart(m.at(1).point({1, 0, 0}), m.at(0).point({1, 0, 0})) < 1e-9);
    CHECK(apart(m.at(1).point({2, 0, 0}), m.at(0).point({1, 1, 0})) < 1e-9);   // a quarter turn
}

TEST_CASE("over an interval: open is 0, close is 1; what rests there stands still") {
    const std::array times{0.0, 1.0, 2.0, 3.0};
    const std::array keys{Affine3d{}, Affine3d{}, turned({0, 0, 1}, 40), turned({0, 0, 1}, 40)};
    const Motion m = Motion::keys(times, keys, Interpolation::decomposed);
    const Vec3d p{1, 0, 0};
    for (const auto& [open, close] : {std::array{1.2, 1.7}, std::array{0.5, 2.5}, std::array{1.0, 2.0}}) {
        const Motion part = m.over(open, close);
        CHECK(part.moves());
        for (const double s : {0.0, 0.3, 0.9, 1.0})
            CHECK(apart(part.at(s).point(p), m.at(open + s * (close - open)).point(p)) < 1e-12);
    }
    CHECK(!m.over(2.5, 7).moves());
    CHECK(!m.over(-2, -1).moves());
    CHECK(!m.over(1.5, 1.5).moves());
    CHECK(apart(m.over(1.5, 1.5).at(0).point(p), m.at(1.5).point(p)) == 0);
}

TEST_CASE("two keys of one time are a jump") {
    const std::array times{0.0, 1.0, 1.0, 2.0};
    const Affine3d far = turned({0, 0, 1}, 0, {10, 0, 0});
    const std::array keys{Affine3d{}, Affine3d{}, far, far};
    const Motion m = Motion::keys(times, keys, Interpolation::decomposed);
    CHECK(m.at(0.999).origin.x == 0);
    CHECK(m.at(1).origin.x == 10);
}

TEST_CASE("keys that cannot be used are refused") {
    const Affine3d sheared{{1, 0, 0}, {0.5, 1, 0}, {0, 0, 1}, {}};
    const Affine3d scaled{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {}};
    CHECK_THROWS_AS(between({}, sheared, Interpolation::slerp), Error);
    CHECK_THROWS_AS(between({}, scaled, Interpolation::twist), Error);
    CHECK_THROWS_AS(Motion::keys({}, {}, Interpolation::linear), Error);
    const std::array falling{1.0, 0.0};
    const std::array keys{Affine3d{}, Affine3d{}};
    CHECK_THROWS_AS(Motion::keys(falling, keys, Interpolation::linear), Error);
}

}  // namespace
}  // namespace dg
