// Thick lens against closed forms of its cardinal points, thin lenses, and exact lenses near the
// axis.
#include "camera/thick.h"

#include <doctest/doctest.h>

#include <cmath>

#include "camera/camera.h"
#include "camera/tilt.h"
#include "math/error.h"
#include "math/hash.h"
#include "optics/lens/test_lenses.h"

namespace dg {
namespace {

std::vector<CameraRay> drawn(const LensKind& lens, Vec2f film_mm, int n, float opening = 1) {
    std::vector<CameraSample> samples(n);
    for (int i = 0; i < n; ++i)
        samples[i] = {film_mm,
                      {float(hash_uniform(1, i)), float(hash_uniform(2, i))},
                      0,
                      float(kDesignWavelength),
                      opening};
    std::vector<CameraRay> rays(n);
    std::visit([&](const auto& kind) { kind.generate(samples, rays); }, lens);
    return rays;
}

double mean_weight(const std::vector<CameraRay>& rays) {
    double sum = 0;
    for (const CameraRay& r : rays) sum += r.weight;
    return sum / double(rays.size());
}

/// Least-squares intersection of rays, and their RMS distance from it, m.
struct Meeting {
    Vec3d point;
    double miss;
};
Meeting meeting(const std::vector<CameraRay>& rays) {
    // In slopes: x + t m = p, with m = d / -d.z and t the depth; least squares in t.
    double n = 0, sm = 0, smm = 0;
    Vec3d so{}, sd{};
    double cross = 0;
    for (const CameraRay& r : rays) {
        const Vec3d m = to_double(r.ray.direction) * (1 / -double(r.ray.direction.z));
        const Vec3d o = to_double(r.ray.origin) + m * double(r.ray.origin.z);   // on the plane z = 0
        so += o, sd += m, n += 1;
    }
    so = so / n, sd = sd / n;
    for (const CameraRay& r : rays) {
        const Vec3d m = to_double(r.ray.direction) * (1 / -double(r.ray.direction.z));
        const Vec3d o = to_double(r.ray.origin) + m * double(r.ray.origin.z);
        cross += (o.x - so.x) * (m.x - sd.x) + (o.y - so.y) * (m.y - sd.y);
        smm += length_squared(Vec2d{m.x - sd.x, m.y - sd.y}), sm += 1;
    }
    const double depth = -cross / smm;
    const Vec3d point{so.x + depth * sd.x, so.y + depth * sd.y, -depth};
    double miss = 0;
    for (const CameraRay& r : rays) {
        const Vec3d d = to_double(r.ray.direction), v = point - to_double(r.ray.origin);
        miss += length_squared(v - d * dot(v, d));
    }
    return {point, std::sqrt(miss / sm)};
}

/// Thin biconvex singlet with the stop at it; its principal planes coincide as gap tends to 0.
Prescription singlet(double gap) {
    return test::lens_from_rows(
        "singlet", {{100, gap, 1.5, 0, 20}, {-100, gap, 1, 0, 20}, {0, gap, 1, 0, 12.5, true}});
}

ThickLens thick_double_gauss(double f_stop, double focus, Vec2d tilt = {}, Iris iris = {}) {
    return {test::check_lens(false, 0.5),
            {f_stop, iris, focus, FocusFrom::pupil, {}, tilt}};
}

}  // namespace

TEST_CASE("a thick lens without thickness is the thin lens, that breathes") {
    const double focus = 1.7;
    const ThickLens thick(singlet(1e-5), {4, {}, focus, FocusFrom::pupil, {}, {}});
    const double f = thick.first_order().efl, s = 1e3 * focus;
    const ThinLens thin{f * s / (s - f), f / 8, focus, {}, true};
    for (const Vec2f film : {Vec2f{0, 0}, {10, -7}, {-18, 12}}) {
        const auto a = drawn(thick, film, 200), b = drawn(thin, film, 200);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const Vec3d d = to_double(a[i].ray.direction);
            CHECK(length(d - to_double(b[i].ray.direction)) < 1e-6);
            const Vec3d at = to_double(a[i].ray.origin) + d * (a[i].ray.origin.z / -d.z);
            CHECK(length(at - to_double(b[i].ray.origin)) < 1e-6);
        }
        CHECK(mean_weight(a) == doctest::Approx(mean_weight(b)).epsilon(0.01));
    }
}

TEST_CASE("a thick lens images every film point to one point of the plane in focus") {
    const double focus = 2.5;
    const ThickLens lens = thick_double_gauss(2.1, focus);
    for (const Vec2f film : {Vec2f{0, 0}, {10, -7}, {-18, 12}}) {
        const Meeting m = meeting(drawn(lens, film, 200));
        CHECK(m.miss < 1e-6);
        CHECK(m.point.z == doctest::Approx(-focus).epsilon(1e-5));
        const Vec3d chief = lens.chief_direction({film.x, film.y});
        CHECK(m.point.x == doctest::Approx(focus * chief.x / -chief.z).epsilon(1e-4));
        CHECK(m.point.y == doctest::Approx(focus * chief.y / -chief.z).epsilon(1e-4));
    }
}

TEST_CASE("thick and exact are one lens near the axis") {
    const double focus = 2.5, f_stop = 16;
    const ThickLens thick = thick_double_gauss(f_stop, focus);
    ExactLensSettings settings;
    settings.f_stop = f_stop, settings.focus_distance_m = focus;
    const ExactLens exact(test::check_lens(false, 0.5), settings);
    CHECK(thick.film_z_mm() == doctest::Approx(exact.film_z_mm()));
    CHECK(thick.iris_radius_mm() == doctest::Approx(exact.iris_radius_mm()));
    CHECK(thick.transmittance() == doctest::Approx(exact.transmittance()).epsilon(1e-6));
    CHECK(thick.h0() == doctest::Approx(exact.h0()).epsilon(2e-3));
    for (const Vec2f film : {Vec2f{0, 0}, {1, 0.5f}, {-0.7f, 1}}) {
        const Meeting a = meeting(drawn(thick, film, 400)), b = meeting(drawn(exact, film, 400));
        CHECK(a.point.x == doctest::Approx(b.point.x).epsilon(2e-3));
        CHECK(a.point.y == doctest::Approx(b.point.y).epsilon(2e-3));
        CHECK(a.point.z == doctest::Approx(b.point.z).epsilon(5e-3));
    }
    CHECK(mean_weight(drawn(thick, {5, 3}, 4000)) ==
          doctest::Approx(mean_weight(drawn(exact, {5, 3}, 4000))).epsilon(0.02));
}

TEST_CASE("weights are exposures over the exit pupil: 1 on the axis, cos^4 off it for a small iris") {
    for (const double f_stop : {2.1, 22.0})
        CHECK(mean_weight(drawn(thick_double_gauss(f_stop, 3), {0, 0}, 20000)) ==
              doctest::Approx(1).epsilon(2e-3));
    const ThickLens small = thick_double_gauss(64, 3);
    const double z = small.film_z_mm() - small.first_order().exit_pupil_z;
    for (const float x : {6.f, 12.f, 18.f}) {
        const double cos2 = z * z / (z * z + x * x);
        CHECK(mean_weight(drawn(small, {x, 0}, 2000)) == doctest::Approx(cos2 * cos2).epsilon(1e-3));
    }
}

TEST_CASE("the shape of the iris changes no exposure, and a leaf shutter takes its area") {
    const double plain = mean_weight(drawn(thick_double_gauss(2.8, 3), {9, 5}, 40000));
    for (const Iris& iris : {Iris::polygon(5, 10, 0), Iris::polygon(6, 0, -0.5)})
        CHECK(mean_weight(drawn(thick_double_gauss(2.8, 3, {}, iris), {9, 5}, 40000)) ==
              doctest::Approx(plain).epsilon(5e-3));
    CHECK(mean_weight(drawn(thick_double_gauss(2.8, 3), {9, 5}, 4000, 0.5f)) ==
          doctest::Approx(plain / 4).epsilon(0.02));
}

TEST_CASE("a tilted lens keeps what is straight ahead, and its axis in focus") {
    const double focus = 2.5;
    for (const Vec2d tilt : {Vec2d{8, 0}, {0, -5}, {6, 4}}) {
        const ThickLens lens = thick_double_gauss(4, focus, tilt);
        const Vec3d ahead = lens.chief_direction({0, 0});
        CHECK(length(ahead - Vec3d{0, 0, -1}) < 1e-12);
        const Vec3d axis = -lens_turn(tilt).z;
        const auto film = lens.film_point(axis, 0);
        REQUIRE(film);
        const Meeting m = meeting(drawn(lens, {float(film->x), float(film->y)}, 400));
        CHECK(m.miss < 1e-6);
        CHECK(length(m.point - axis * focus) < 1e-4 * focus);
    }
}

TEST_CASE("the plane in focus meets film and lens in one line (Scheimpflug)") {
    const double focus = 1.5;
    const Vec2d tilt{7, 0};
    const ThinLens thin{50, 6, focus, {}, false, tilt};
    const ThickLens thick = thick_double_gauss(4, focus, tilt);
    // Sections with x = 0, in m. The hinge is the intersection of the film's plane with the front
    // principal plane in object space: for a thick lens, the film is first moved from the rear
    // principal plane to the front one.
    const double a = tilt.x * kPiD / 180;
    for (const bool is_thin : {true, false}) {
        std::vector<Vec3d> sharp;
        for (const float y : {-9.f, 0.f, 9.f}) {
            const auto rays = is_thin ? drawn(thin, {0, y}, 300) : drawn(thick, {0, y}, 300);
            const Meeting m = meeting(rays);
            CHECK(m.miss < 1e-6);
            sharp.push_back(m.point);
        }
        // Three sharp points are on a line through the hinge.
        const Vec3d along = normalize(sharp[2] - sharp[0]);
        const auto off = [&](Vec3d p) {
            return std::abs((p - sharp[0]).y * along.z - (p - sharp[0]).z * along.y);
        };
        CHECK(off(sharp[1]) < 1e-4);
        const FirstOrder& o = thick.first_order();
        const double front = is_thin ? 0 : 1e-3 * (o.front_principal_z - o.entrance_pupil_z);
        const double hiatus = is_thin ? 0 : 1e-3 * (o.back_principal_z - o.front_principal_z);
        const double film = is_thin ? 0.05 : 1e-3 * (thick.film_z_mm() - o.entrance_pupil_z) * std::cos(a);
        // Upward along the lens plane (0, cos a, sin a) from its foot on the axis. The film plane
        // is at z = film, moved forward by the hiatus along the axis, of which cos a is the z
        // component.
        const double up = (film - (front + hiatus) * std::cos(a)) / std::sin(a);
        const Vec3d hinge = Vec3d{0, -std::sin(a), std::cos(a)} * front + Vec3d{0, std::cos(a), std::sin(a)} * up;
        CHECK(off(hinge) < 1e-4);
    }
}

TEST_CASE("a tilted thick lens exposes its film as the exact one does: the film's own cosine counts") {
    ExactLensSettings settings;
    settings.f_stop = 8, settings.focus_distance_m = 3, settings.tilt_deg = {10, 0};
    const ExactLens exact(test::check_lens(false, 0.5), settings);
    const ThickLens thick = thick_double_gauss(8, 3, {10, 0});
    const auto ratio = [](const LensKind& lens) {
        return mean_weight(drawn(lens, {0, 6}, 8000)) / mean_weight(drawn(lens, {0, -6}, 8000));
    };
    CHECK(std::abs(ratio(thick) / ratio(exact) - 1) < 0.015);
}

TEST_CASE("a state of a lens that moves looks out from where its body puts it, and is as bright as it is") {
    const ThickLens near = thick_double_gauss(4, 1), far = thick_double_gauss(4, 3);
    const ThickLens state = near.in_the_body_of(far);
    const double out = (near.film_z_mm() - far.film_z_mm()) * 1e-3;   // the film is fixed, the lens moves forward
    CHECK(out > 1e-3);
    const double alone = meeting(drawn(near, {3, 2}, 500)).point.z;
    CHECK(std::abs(meeting(drawn(state, {3, 2}, 500)).point.z - alone + out) < 1e-4);
    const double bright = mean_weight(drawn(state, {0, 0}, 4000)) / mean_weight(drawn(near, {0, 0}, 4000));
    CHECK(std::abs(bright * far.h0() / near.h0() - 1) < 1e-5);
    CHECK(near.h0() < 0.99 * far.h0());
}

TEST_CASE("the film of a tilted lens that moves stays: its axis meets it elsewhere") {
    const Vec2d tilt{6, -4};
    const ThickLens near = thick_double_gauss(4, 1, tilt), far = thick_double_gauss(4, 3, tilt);
    const Vec3d axis = lens_turn(tilt).z;
    const auto on = near.in_the_body_of(far).film_point(-axis, 0), before = far.film_point(-axis, 0);
    REQUIRE((on && before));
    const Vec2d expected = Vec2d{axis.x, axis.y} * (far.film_z_mm() - near.film_z_mm());
    CHECK(length(expected) > 0.1);   // mm
    CHECK(length(*on - *before - expected) < 1e-9);
}

}  // namespace dg
