#include "optics/first_order/seidel.h"

#include <doctest/doctest.h>

#include "math/error.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/trace.h"

using namespace dg;

namespace {

constexpr double kSlope = 0.2;

/// Transverse aberration of an exact ray at the Gaussian image plane, relative to the Gaussian
/// image point; pupil coordinates and field in units of `rays`.
Vec2d traced(const Prescription& lens, const SeidelRays& rays, Vec2d pupil, double field) {
    const FirstOrder f = first_order(lens);
    const Tracer tracer(lens);
    const double slope = field * rays.field_slope, z = f.entrance_pupil_z;
    const auto out = tracer.to_film({{rays.pupil_radius * pupil.x, rays.pupil_radius * pupil.y, z},
                                     normalize(Vec3d{0, slope, 1})},
                                    tracer.at(kDesignWavelength), {false, nullptr, 0});
    REQUIRE(out);
    const Vec3d at = at_plane(out->ray, f.back_focal_z);
    return {at.x, at.y - f.efl * slope};
}

/// Third-order transverse aberration, grad W / (n'u').
Vec2d third_order(const Seidel& sums, Vec2d p, double h) {
    const SeidelSums& s = sums.total;
    const double r2 = dot(p, p), k = 1 / sums.image_convergence;
    const double dx = s.s1 / 2 * r2 * p.x + s.s2 * h * p.x * p.y +
                      (s.s3 + s.s4) / 2 * h * h * p.x;
    const double dy = s.s1 / 2 * r2 * p.y + s.s2 / 2 * h * (r2 + 2 * p.y * p.y) +
                      (3 * s.s3 + s.s4) / 2 * h * h * p.y + s.s5 / 2 * h * h * h;
    return {k * dx, k * dy};
}

Prescription aspheric() {
    Prescription lens = test::check_lens(true, 0.5);
    lens.name = "aspheric";
    lens.surfaces[0].conic = -0.7;
    lens.surfaces[0].asphere = {{2, 1e-4}, {4, 2e-6}, {6, -3e-9}};
    lens.surfaces[8].conic = 0.4;
    lens.surfaces[8].asphere = {{4, -3e-6}, {8, 1e-12}};
    return lens;
}

}  // namespace

TEST_CASE("Seidel sums are the third-order aberration of exact rays") {
    std::vector<Prescription> lenses = test::all_lenses();
    lenses.push_back(aspheric());
    for (const Prescription& lens : lenses) {
        CAPTURE(lens.name);
        const FirstOrder f = first_order(lens);
        const SeidelRays rays{0.15 * f.entrance_pupil_diameter, kSlope};
        const Seidel sums = seidel(lens, kDesignWavelength, rays);
        const double size = length(third_order(sums, {0.6, 0.8}, 1));
        for (const auto& [pupil, field] :
             {std::pair{Vec2d{0, 1}, 0.0}, {{0, 0}, 1.0}, {{0.6, 0.8}, 1.0}, {{1, 0}, 0.7},
              {{0, -1}, 1.0}, {{-0.5, 0.3}, -0.8}}) {
            const Vec2d expected = third_order(sums, pupil, field);
            // With pupil and field scaled by t, aberration / t^3 tends to the third-order value
            // with an error of order t^2.
            const auto scaled = [&](double t) {
                return traced(lens, rays, t * pupil, t * field) * (1 / (t * t * t));
            };
            const Vec2d coarse = scaled(0.04), fine = scaled(0.02);
            const Vec2d limit = (1 / 3.0) * (4.0 * fine - coarse);
            CHECK(length(limit - expected) < 1e-4 * size);
            // The aberration has a log-log slope of 3.
            if (length(expected) > 0.1 * size) {
                const double slope =
                    3 + std::log(length(coarse) / length(fine)) / std::log(2.0);
                CHECK(slope == doctest::Approx(3).epsilon(0.01));
            }
        }
    }
}

TEST_CASE("chromatic sums are the first-order step between two wavelengths") {
    const Prescription lens = test::tessar();
    const FirstOrder f = first_order(lens);
    // Two close wavelengths: the difference of the indices approximates the differential.
    const double shorter = kDesignWavelength - 0.05, longer = kDesignWavelength + 0.05;
    const SeidelRays rays{0.5 * f.entrance_pupil_diameter, kSlope};
    const Seidel sums = seidel(lens, kDesignWavelength, rays, shorter, longer);
    const FirstOrder blue = first_order(lens, shorter), red = first_order(lens, longer);
    const double u = sums.image_convergence;
    // W = C1/2 r^2 moves the focus by -C1 / (n'u'^2).
    const double axial = blue.back_focal_z - red.back_focal_z;
    CHECK(std::abs(axial + sums.total.c1 / (u * u)) < 1e-4 * std::abs(axial));
    // The chief rays of both wavelengths pass the centre of the stop; at the film they are C2 /
    // (n'u') apart.
    const auto chief = [&](const FirstOrder& order) {
        // Height at the film of a ray of slope kSlope through the centre of the entrance pupil.
        return kSlope / order.exit_magnification * order.entrance_magnification *
               (f.back_focal_z - order.exit_pupil_z);
    };
    const double lateral = chief(blue) - chief(red);
    CHECK(std::abs(lateral - sums.total.c2 / u) < 1e-3 * std::abs(lateral));
}

TEST_CASE("a finite object: spherical aberration of a ball's aplanatic point is zero") {
    // Aplanatic points: rays toward the distance r n behind the centre of a sphere of index n
    // converge at r / n.
    Prescription ball = test::lens_from_rows("ball", {{0, 0, 1, 0, 5, true}, {10, 40, 1.5, 0, 5}});
    ball.surfaces.back().glass.formula = ConstantIndex{1.5};
    // Virtual object at z = 10 + 15 from the vertex: a negative distance from the pupil.
    const Seidel sums = seidel(ball, kDesignWavelength, {3, 0.1, -25});
    CHECK(std::abs(sums.total.s1) < 1e-14);
    CHECK(std::abs(sums.total.s2) < 1e-14);
    CHECK(std::abs(seidel(ball, kDesignWavelength, {3, 0.1, -20}).total.s1) > 1e-3);
}

TEST_CASE("lenses without symmetry have no Seidel sums") {
    Prescription lens = test::tessar();
    lens.surfaces[1].decenter = {1, 0, 0};
    CHECK_THROWS_WITH_AS(seidel(lens, kDesignWavelength, {1, 0.1}),
                         doctest::Contains("axial symmetry"), Error);
}
