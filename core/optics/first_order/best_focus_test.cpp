#include "optics/first_order/best_focus.h"

#include <doctest/doctest.h>

#include "math/error.h"
#include "optics/first_order/seidel.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

/// Relative comparison; doctest's Approx also accepts an absolute error.
bool close(double got, double wanted, double relative) {
    return std::abs(got - wanted) <= relative * std::abs(wanted);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::vector<WeightedWavelength> kYellow = {{kDesignWavelength, 1}};

}  // namespace

TEST_CASE("stopped down, the best focus is the paraxial one") {
    for (const Prescription& lens : test::all_lenses()) {
        const FirstOrder f = first_order(lens);
        for (const double distance : {kInfinity, 3.0})
            for (const FocusFrom from : {FocusFrom::pupil, FocusFrom::sensor}) {
                const BestFocus best = best_focus(lens, 200, distance, from, kYellow);
                const double paraxial = film_position(lens, f, distance, from);
                CHECK(std::abs(best.film_z - paraxial) < 3e-4 * f.efl);
            }
    }
}

TEST_CASE("third-order spherical aberration: two thirds of the marginal ray's, spot a third") {
    // W = a r^4 - d r^2 / 2 has the transverse error 4 a r^3 - d r. Least squares over the disc
    // gives d = 8/3 a; the marginal ray's focus is at d = 4 a. The RMS radius there is 1/3 of the
    // RMS radius at the paraxial focus.
    const Prescription lens = test::check_lens(true, 0.5);
    const FirstOrder f = first_order(lens);
    const double f_stop = 30;
    const Seidel sums = seidel(lens, kDesignWavelength, {0.5 * f.efl / f_stop, 0});
    const double u = sums.image_convergence, marginal = -sums.total.s1 / (2 * u * u);
    const BestFocus best = best_focus(lens, f_stop, kInfinity, FocusFrom::pupil, kYellow);
    CHECK(close(best.film_z - f.back_focal_z, 2.0 / 3 * marginal, 0.03));
    // RMS at the paraxial focus: |S1 / (2 u)| sqrt(mean r^6) = |S1 / (2 u)| / 2.
    CHECK(close(best.rms, std::abs(sums.total.s1 / u) / 12, 0.03));
}

TEST_CASE("the place found is the smallest of its neighbours, whatever the lens") {
    Prescription toric = test::tessar();
    toric.surfaces[0].shape = Shape::biconic;
    toric.surfaces[0].curvature_x = 1.002 * toric.surfaces[0].curvature;
    const BestFocus best = best_focus(toric, 4, 2);
    const BestFocus round = best_focus(test::tessar(), 4, 2);
    CHECK(best.rms > 1.4 * round.rms);
    // The best focus is between the foci of the two sections.
    const double y = film_position(toric, first_order(toric), 2);
    const double x = film_position(toric, first_order(toric, kDesignWavelength, Section::x), 2);
    CHECK(x < y - 0.02);
    CHECK(close(best.film_z - round.film_z, 0.5 * (x - y), 0.2));
}

TEST_CASE("a lens that lets nothing through on the axis is an error") {
    Prescription lens = test::tessar();
    lens.surfaces[2].inner_semi_diameter = 0.999 * lens.surfaces[2].semi_diameter;
    CHECK_THROWS_WITH_AS(best_focus(lens, 5.6, 2), doctest::Contains("no ray that passes"), Error);
}
