#include "optics/first_order/paraxial.h"

#include <doctest/doctest.h>

#include <limits>

#include "math/error.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/trace.h"

using namespace dg;

namespace {

/// z at which a ray from the axis at z_object, at a small angle, crosses the axis behind the lens.
double image_of(const Prescription& lens, double z_object) {
    const Tracer tracer(lens);
    const auto ray =
        tracer.to_film({{0, 0, z_object}, normalize(Vec3d{1e-3 / -z_object, 0, 1})},
                       tracer.at(kDesignWavelength), {});
    REQUIRE(ray);
    return ray->ray.origin.z -
           ray->ray.origin.x * ray->ray.direction.z / ray->ray.direction.x;
}

}  // namespace

TEST_CASE("the check lens has its published focal lengths") {
    const FirstOrder rounded = first_order(test::check_lens());
    CHECK(rounded.efl == doctest::Approx(100.716).epsilon(5e-6));
    CHECK(rounded.bfl == doctest::Approx(72.212).epsilon(7e-6));
    const FirstOrder patent = first_order(test::check_lens(true));
    CHECK(patent.efl == doctest::Approx(100.015).epsilon(5e-6));
    CHECK(patent.bfl == doctest::Approx(71.445).epsilon(7e-6));
    // Lengths scale with the lens.
    CHECK(first_order(test::check_lens(true, 0.5)).efl ==
          doctest::Approx(0.5 * patent.efl));
}

TEST_CASE("cardinal points and pupils against exact rays close to the axis") {
    for (const Prescription& lens : test::all_lenses()) {
        const FirstOrder f = first_order(lens);
        const Tracer tracer(lens);
        const LensIndices n = tracer.at(kDesignWavelength);
        const double h = 1e-5;
        const auto parallel = tracer.to_film({{h, 0, -10}, {0, 0, 1}}, n, {});
        REQUIRE(parallel);
        const double slope = parallel->ray.direction.x / parallel->ray.direction.z;
        CHECK(-h / slope == doctest::Approx(f.efl).epsilon(1e-8));
        CHECK(parallel->ray.origin.z - parallel->ray.origin.x / slope ==
              doctest::Approx(f.back_focal_z).epsilon(1e-8));
        const auto back = tracer.to_scene({{h, 0, f.back_focal_z}, {0, 0, -1}}, n, {});
        REQUIRE(back);
        const double out = back->ray.direction.x / back->ray.direction.z;
        CHECK(back->ray.origin.z - back->ray.origin.x / out ==
              doctest::Approx(f.front_focal_z).epsilon(1e-7));
        // A ray toward the centre of the entrance pupil crosses the centre of the stop, and leaves
        // along a line through the centre of the exit pupil.
        const auto chief = tracer.to_film(
            {{-1e-4 * (f.entrance_pupil_z + 10), 0, -10}, normalize(Vec3d{1e-4, 0, 1})},
            n, {});
        REQUIRE(chief);
        CHECK(std::abs(chief->iris.x) < 1e-9 + 1e-6 * 1e-4 * f.efl);
        const double chief_slope = chief->ray.direction.x / chief->ray.direction.z;
        CHECK(chief->ray.origin.z - chief->ray.origin.x / chief_slope ==
              doctest::Approx(f.exit_pupil_z).epsilon(1e-5));
        CHECK(std::abs(parallel->iris.x / h * f.entrance_magnification) ==
              doctest::Approx(1).epsilon(1e-7));
    }
}

TEST_CASE("focus is the exact conjugate, from the pupil and from the sensor") {
    for (const Prescription& lens : test::all_lenses()) {
        const FirstOrder f = first_order(lens);
        for (const double m : {2.0, 5.0, 40.0}) {
            const double film = film_position(lens, f, m);
            CHECK(film == doctest::Approx(image_of(lens, f.entrance_pupil_z - 1e3 * m))
                              .epsilon(1e-8));
            const double from_sensor = film_position(lens, f, m, FocusFrom::sensor);
            CHECK(from_sensor ==
                  doctest::Approx(image_of(lens, from_sensor - 1e3 * m)).epsilon(1e-8));
        }
        CHECK(film_position(lens, f, std::numeric_limits<double>::infinity()) ==
              f.back_focal_z);
    }
}

TEST_CASE("too close is an error that names the nearest distance, which then works") {
    const Prescription lens = test::check_lens(true, 0.5);
    const FirstOrder f = first_order(lens);
    for (const FocusFrom from : {FocusFrom::pupil, FocusFrom::sensor}) {
        std::string message;
        try {
            film_position(lens, f, 0.03, from);
        } catch (const Error& e) {
            message = e.what();
        }
        CHECK(message.find("nearest possible") != std::string::npos);
        const double nearest = std::stod(message.substr(message.find("wanted ") + 7));
        CHECK(nearest > 0.04);
        CHECK(nearest < 0.25);
        CHECK(nearest == doctest::Approx(closest_focus_m(lens, f, from)).epsilon(1e-3));
        CHECK_NOTHROW(film_position(lens, f, nearest * 1.001, from));
        CHECK_THROWS_AS(film_position(lens, f, nearest * 0.99, from), Error);
    }
    CHECK_THROWS_AS(film_position(lens, f, -1), Error);
    CHECK_THROWS_AS(film_position(lens, f, std::nan("")), Error);
}

TEST_CASE(
    "the iris of an f-stop; wider than the lens is an error that names the widest") {
    const Prescription lens = test::check_lens(true, 0.5);
    const FirstOrder f = first_order(lens);
    CHECK(f.f_number == doctest::Approx(2.0134).epsilon(1e-4));
    CHECK(iris_radius(lens, f, 4) == doctest::Approx(2 * iris_radius(lens, f, 8)));
    CHECK(iris_radius(lens, f, f.f_number) == doctest::Approx(8.55));
    CHECK_THROWS_WITH_AS(iris_radius(lens, f, 1.4), doctest::Contains("f/2.01"), Error);
    CHECK_THROWS_AS(iris_radius(lens, f, 0), Error);
}

TEST_CASE("no iris has a radius where the stop has no size, at any f-stop") {
    Prescription lens = test::check_lens();
    lens.surfaces[lens.stop_index()].semi_diameter = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(iris_radius(lens, first_order(lens), 8), doctest::Contains("size of the stop"),
                         Error);
    lens.nominal_f_number = 4;
    CHECK(iris_radius(lens, first_order(lens), 8) > 0);
}

TEST_CASE("prescriptions that cannot be are refused with surface and value") {
    const auto refused = [](auto change, const char* says) {
        Prescription lens = test::check_lens();
        change(lens);
        CHECK_THROWS_WITH_AS(validate(lens), doctest::Contains(says), Error);
    };
    refused([](Prescription& l) { l.surfaces[2].curvature = std::nan(""); },
            "surface 2: curvature");
    refused([](Prescription& l) { l.surfaces[2].thickness = -1; },
            "surface 2: thickness");
    refused([](Prescription& l) { l.surfaces[4].semi_diameter = 30; },
            "surface 4: semi-diameter");
    refused([](Prescription& l) { l.surfaces[5].stop = false; }, "stops");
    refused([](Prescription& l) { l.surfaces[1].stop = true; }, "stops");
    refused([](Prescription& l) { l.surfaces.clear(); }, "at least one surface");
    Prescription plane = test::lens_from_rows(
        "plate", {{0, 5, 1.5, 60, 10}, {0, 5, 1, 0, 10}, {0, 0, 1, 0, 5, true}});
    CHECK_THROWS_WITH_AS(first_order(plane), doctest::Contains("afocal"), Error);
}

TEST_CASE("a cylinder has power in one section only") {
    Prescription lens = test::tessar();
    for (Surface& s : lens.surfaces) {
        s.curvature_x = s.curvature, s.shape = Shape::biconic;
        s.curvature = 0;
    }
    const FirstOrder f = first_order(lens, kDesignWavelength, Section::x);
    CHECK(f.efl == doctest::Approx(first_order(test::tessar()).efl));
    CHECK_THROWS_WITH_AS(first_order(lens), doctest::Contains("afocal"), Error);
}

TEST_CASE("in water the nodal points leave the principal points") {
    Prescription lens = test::tessar();
    lens.object_medium.formula = ConstantIndex{1.333};
    const FirstOrder f = first_order(lens);
    CHECK(f.back_nodal_z - f.back_principal_z ==
          doctest::Approx(f.efl - 1.333 * f.efl).epsilon(1e-9));
    CHECK(f.front_nodal_z - f.front_principal_z ==
          doctest::Approx(f.back_nodal_z - f.back_principal_z));
    // A ray toward the front nodal point leaves from the rear nodal point with the same slope.
    const Tracer tracer(lens);
    const auto ray = tracer.to_film({{0, 0, f.front_nodal_z}, normalize(Vec3d{1e-5, 0, 1})},
                                    tracer.at(kDesignWavelength), {false, nullptr, 0});
    REQUIRE(ray);
    const double slope = ray->ray.direction.x / ray->ray.direction.z;
    CHECK(slope == doctest::Approx(1e-5).epsilon(1e-6));
    CHECK(ray->ray.origin.z - ray->ray.origin.x / slope ==
          doctest::Approx(f.back_nodal_z).epsilon(1e-6));
}

TEST_CASE("a stop inside glass: pupils seen through the media on its own sides") {
    // Ball of glass with the stop at its centre: central rays are not refracted, so both pupils are
    // at the stop, magnified n times.
    Prescription ball = test::lens_from_rows(
        "ball", {{10, 10, 1.5, 0, 9.9}, {0, 10, 1.5, 0, 2, true}, {-10, 0, 1, 0, 9.9}});
    const FirstOrder f = first_order(ball);
    CHECK(f.entrance_pupil_z == doctest::Approx(10));
    CHECK(f.exit_pupil_z == doctest::Approx(10));
    CHECK(f.entrance_magnification == doctest::Approx(1.5));
    CHECK(f.exit_magnification == doctest::Approx(1.5));
    CHECK(pupil_magnification(f) == doctest::Approx(1));
}

TEST_CASE("the working f-number is that of the marginal ray") {
    for (const Prescription& lens : test::all_lenses()) {
        const FirstOrder f = first_order(lens);
        const double film = film_position(lens, f, 0.8), m = magnification(f, film);
        const double z = f.entrance_pupil_z - 800;
        const Tracer tracer(lens);
        const double h = 1e-4;  // height in the entrance pupil, for a lens at f / (2 h)
        const auto ray = tracer.to_film({{0, 0, z}, normalize(Vec3d{h / 800, 0, 1})},
                                        tracer.at(kDesignWavelength), {false, nullptr, 0});
        REQUIRE(ray);
        const double slope = std::abs(ray->ray.direction.x / ray->ray.direction.z);
        CHECK(working_f_number(f, f.efl / (2 * h), m) ==
              doctest::Approx(1 / (2 * slope)).epsilon(1e-6));
        CHECK(m < 0);
    }
}
