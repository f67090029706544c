#include "camera/projection_model.h"

#include <doctest/doctest.h>

#include <cmath>

#include "camera/model_cases.h"
#include "math/error.h"

using namespace dg;
using Kind = ProjectionModel::Kind;

namespace {

/// Direction at an angle from the axis, rotated about it.
Vec3d direction(double angle, double turn) {
    return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

}  // namespace

TEST_CASE("a direction comes back from its point, and a point from its direction") {
    for (const test::ModelCase& c : test::model_cases()) {
        CAPTURE(c.name);
        double worst = 0;
        int seen = 0;
        for (int i = 0; i <= 60; ++i)
            for (int j = 0; j < 24; ++j) {
                const Vec3d d = direction(c.far * i / 60, 0.13 + j * 2 * kPiD / 24);
                const auto p = c.model.project(3.7 * d);
                if (!p) continue;
                const auto back = c.model.unproject(*p);
                REQUIRE(back.has_value());
                ++seen;
                worst = std::max({worst, length(*back - d), std::abs(length(*back) - 1)});
                const auto again = c.model.project(*back);
                REQUIRE(again.has_value());
                worst = std::max(worst, length(*again - *p));
            }
        CHECK(seen >= 61 * 24 * 9 / 10);
        CHECK(worst < 1e-9);
    }
}

TEST_CASE("solid angle is the area of the sphere that a piece of the picture covers") {
    for (const test::ModelCase& c : test::model_cases()) {
        CAPTURE(c.name);
        for (double angle : {0.1, 0.4, 0.7}) {
            const auto p = c.model.project(direction(angle, 0.6));
            REQUIRE(p.has_value());
            const double h = 1e-3;
            const auto a = c.model.unproject(*p), b = c.model.unproject({p->x + h, p->y}),
                       d = c.model.unproject({p->x, p->y + h});
            REQUIRE((a && b && d));
            const double area = length(cross(*b - *a, *d - *a)) / (h * h);
            CHECK(c.model.solid_angle(*p) == doctest::Approx(area).epsilon(5e-3));
        }
    }
}

TEST_CASE("the rim of an eucm of alpha 1 sees nothing") {
    const ProjectionModel model(Kind::eucm, {1, 1});
    CHECK(model.unproject({0.999999, 0}).has_value());
    CHECK_FALSE(model.unproject({1, 0}).has_value());
}

TEST_CASE("ends of the field are those of the radial part, however far a prism bends the rest to one side") {
    const ProjectionModel plain(Kind::opencv, {-0.3}), bent(Kind::opencv, {-0.3, 0, 0, 0, 0, 0, 0, 0, -5});
    CHECK(bent.largest_radius() == plain.largest_radius());
    CHECK(bent.largest_angle() == plain.largest_angle());
}

TEST_CASE("the inverse of opencv takes points of the picture to ideal ones by its terms") {
    const std::array<double, ProjectionModel::kMost> k{-0.2, 0.03, 2e-3, -3e-3, 0.01, -0.05};
    const ProjectionModel there(Kind::opencv, k), back(Kind::opencv_inverse, k);
    for (const Vec2d p : {Vec2d{0.3, -0.2}, {-0.5, 0.4}, {0, 0.1}}) {
        const Vec3d seen = *back.unproject(p);
        const Vec2d ideal = *there.project({p.x, p.y, 1});
        CHECK(seen.x / seen.z == doctest::Approx(ideal.x));
        CHECK(seen.y / seen.z == doctest::Approx(ideal.y));
    }
    const ProjectionModel folds(Kind::opencv_inverse, {-0.3});
    const double edge = 1 / std::sqrt(0.9), ideal = edge * (1 - 0.3 * edge * edge);
    CHECK(folds.largest_radius() == doctest::Approx(edge).epsilon(2e-3));
    CHECK(std::tan(folds.largest_angle()) == doctest::Approx(ideal).epsilon(2e-3));
    CHECK(folds.unproject({0.98 * edge, 0}).has_value());
    CHECK_FALSE(folds.unproject({0, 1.02 * edge}).has_value());
    CHECK(folds.project({0.99 * ideal, 0, 1}).has_value());
    CHECK_FALSE(folds.project({1.01 * ideal, 0, 1}).has_value());
}

TEST_CASE("a panorama goes on beyond its edges, at its other side and over its poles") {
    const ProjectionModel panorama(Kind::equirectangular);
    for (const Vec2d p : {Vec2d{3.2, 0.3}, {-3.3, -1.2}, {0.4, 1.7}, {-2.5, -1.6}, {3.15, 1.58}, {0.5, 0.5}, {7, 4}}) {
        const auto seen = panorama.unproject(panorama.continued(p));
        REQUIRE(seen.has_value());
        const Vec3d formula{std::cos(p.y) * std::sin(p.x), std::sin(p.y), std::cos(p.y) * std::cos(p.x)};
        CHECK(length(*seen - formula) < 1e-12);
    }
    CHECK_FALSE(ProjectionModel(Kind::equisolid).unproject(ProjectionModel(Kind::equisolid).continued({3, 3})));
}

TEST_CASE("closed forms of fisheyes and panoramas") {
    const double t = 1.1;
    const auto radius = [&](Kind kind) { return ProjectionModel(kind).project(direction(t, 0))->x; };
    CHECK(radius(Kind::rectilinear) == doctest::Approx(std::tan(t)));
    CHECK(radius(Kind::equidistant) == doctest::Approx(t));
    CHECK(radius(Kind::equisolid) == doctest::Approx(2 * std::sin(t / 2)));
    CHECK(radius(Kind::stereographic) == doctest::Approx(2 * std::tan(t / 2)));
    CHECK(radius(Kind::orthographic) == doctest::Approx(std::sin(t)));
    const auto right = ProjectionModel(Kind::equirectangular).project({1, 0, 0});
    CHECK(right->x == doctest::Approx(kPiD / 2));
    const auto below = ProjectionModel(Kind::equirectangular).project({0, 1, 1});
    CHECK(below->y == doctest::Approx(kPiD / 4));
    const ProjectionModel cube(Kind::cube);
    CHECK(cube.project({0, 0, 1})->x == doctest::Approx(1.5));      // ahead: the fifth face
    CHECK(cube.project({1, 0, 0})->x == doctest::Approx(-2.5));     // right: the first face
    CHECK(cube.project({0.2, 0.1, 1})->x == doctest::Approx(1.6));
    CHECK(cube.project({0.2, 0.1, 1})->y == doctest::Approx(0.05));
}

TEST_CASE("beyond its fold, or behind it, a model sees nothing") {
    const ProjectionModel barrel(Kind::opencv, {-0.3});
    const double fold = 1 / std::sqrt(0.9);   // 1 - 3 * 0.3 r^2 = 0
    CHECK(std::tan(barrel.largest_angle()) == doctest::Approx(fold).epsilon(1e-12));
    CHECK(barrel.project(direction(std::atan(0.98 * fold), 0.3)).has_value());
    CHECK_FALSE(barrel.project(direction(std::atan(1.02 * fold), 0.3)).has_value());
    const double last = fold * (1 - 0.3 * fold * fold);
    CHECK(barrel.unproject({0.99 * last, 0}).has_value());
    CHECK_FALSE(barrel.unproject({1.01 * last, 0}).has_value());
    CHECK_FALSE(barrel.project({0, 0, -1}).has_value());
    const ProjectionModel fisheye(Kind::kannala_brandt, {-0.1});
    const double turn = std::sqrt(1 / 0.3);
    CHECK(fisheye.largest_angle() == doctest::Approx(turn).epsilon(1e-3));
    CHECK_FALSE(fisheye.project(direction(turn + 0.01, 0)).has_value());
    CHECK_FALSE(fisheye.unproject({turn, 0}).has_value());
    CHECK_FALSE(ProjectionModel(Kind::equisolid).unproject({2.01, 0}).has_value());
    CHECK_FALSE(ProjectionModel(Kind::double_sphere, {0.2, 0.7}).unproject({3, 0}).has_value());
    CHECK_FALSE(ProjectionModel(Kind::rectilinear).project({1, 0, 0}).has_value());
    CHECK_FALSE(ProjectionModel(Kind::cube).unproject({3.2, 0}).has_value());
}

TEST_CASE("an f-theta model gives the angle of a radius by its polynomial, up to where it turns or looks behind") {
    const ProjectionModel model(Kind::ftheta, {0.02, -0.1, 0.01, 0.002});
    for (const double r : {0.2, 0.9, 1.3}) {
        const double angle = r + 0.02 * r * r - 0.1 * r * r * r + 0.01 * r * r * r * r + 0.002 * std::pow(r, 5);
        const Vec3d seen = *model.unproject({0.6 * r, -0.8 * r});
        CHECK(length(seen - direction(angle, std::atan2(-0.8, 0.6))) < 1e-14);
    }
    const ProjectionModel turns(Kind::ftheta, {-0.25});   // slope 1 - r / 2
    CHECK(turns.largest_radius() == doctest::Approx(2).epsilon(1e-12));
    CHECK(turns.largest_angle() == doctest::Approx(1).epsilon(1e-12));
    CHECK(turns.unproject({1.999, 0}).has_value());
    CHECK_FALSE(turns.unproject({2.001, 0}).has_value());
    CHECK_FALSE(turns.project(direction(1.001, 0)).has_value());
    const ProjectionModel behind(Kind::ftheta, {0, 0.1});   // ends where r + r^3 / 10 is pi
    const double last = behind.largest_radius();
    CHECK(last + 0.1 * last * last * last == doctest::Approx(kPiD).epsilon(1e-12));
    CHECK(ProjectionModel(Kind::ftheta, {-1e3}).largest_radius() == doctest::Approx(5e-4).epsilon(1e-9));
}

TEST_CASE("where tangential terms or a tilted sensor fold the picture, points have one direction or none") {
    const ProjectionModel tangential(Kind::opencv, {0, 0, 0.3, -0.2});
    const ProjectionModel tilted(Kind::opencv, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.9, -0.4});
    for (const ProjectionModel& model : {tangential, tilted}) {
        int seen = 0, refused = 0;
        for (int i = 0; i <= 80; ++i)
            for (int j = 0; j < 48; ++j) {
                const Vec3d d = direction(0.018 * i, 0.13 + j * 2 * kPiD / 48);
                const auto p = model.project(d);
                const auto back = p ? model.unproject(*p) : std::nullopt;
                ++(p ? seen : refused);
                if (p) CHECK((back && length(*back - d) < 1e-8));
            }
        CHECK(std::min(seen, refused) > 300);
    }
}

TEST_CASE("models of one and two spheres see up to one edge, whichever way it is asked") {
    const double kSets[][2] = {{-0.9, 0.9}, {-0.3, 0.7}, {0, 0.6}, {0.3, 0.4}, {0.9, 0.9},
                               {1, 0.5},    {1, 1},      {1.5, 0.5}, {2, 0.3}};
    for (const auto& set : kSets)
        for (const Kind kind : {Kind::double_sphere, Kind::eucm, Kind::omni}) {
            const ProjectionModel model = kind == Kind::double_sphere ? ProjectionModel(kind, {set[0], set[1]})
                                          : kind == Kind::eucm ? ProjectionModel(kind, {set[1], 1.5 + set[0] / 2})
                                                               : ProjectionModel(kind, {std::abs(set[0])});
            CAPTURE(int(kind));
            CAPTURE(set[0]);
            CAPTURE(set[1]);
            for (int i = 0; i < 4000; ++i) {
                const double r = 0.001 * (i + 0.5);   // rings of the image
                const auto d = model.unproject({0.6 * r, 0.8 * r});
                if (!d) continue;
                const auto p = model.project(*d);
                REQUIRE(p.has_value());
                CHECK(length(*p - Vec2d{0.6 * r, 0.8 * r}) < 1e-6 * std::max(r, 1.0));
            }
            for (int i = 0; i < 1000; ++i) {
                const Vec3d d = direction(kPiD * (i + 0.5) / 1000, 0.7);   // rings of the world
                const auto p = model.project(d);
                if (!p) continue;
                const auto back = model.unproject(*p);
                REQUIRE(back.has_value());
                CHECK(length(*back - d) < 1e-6);
                CHECK(kPiD * (i + 0.5) / 1000 <= model.largest_angle());
            }
            const double near = model.largest_angle() - 1e-4;
            if (near < 3.14) CHECK(model.project(direction(near, 0.7)).has_value());
        }
}

TEST_CASE("parameters that make no model are named") {
    const auto message = [](Kind kind, std::array<double, 14> k) {
        try {
            ProjectionModel(kind, k);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    CHECK(message(Kind::double_sphere, {0, 1.5}).find("alpha") != std::string::npos);
    CHECK(message(Kind::eucm, {0.5, -1}).find("beta") != std::string::npos);
    CHECK(message(Kind::fov, {0}).find("w:") != std::string::npos);
    CHECK(message(Kind::opencv, {NAN}).find("finite") != std::string::npos);
}
