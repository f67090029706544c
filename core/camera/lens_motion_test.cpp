// Lenses that change during the exposure: rays match the lens at their time.
#include <doctest/doctest.h>

#include <cmath>

#include "camera/camera.h"
#include "math/hash.h"
#include "optics/lens/test_lenses.h"

namespace dg {
namespace {

std::vector<CameraSample> samples_at(float time, int n, Vec2f film_mm = {3, 2}) {
    std::vector<CameraSample> samples;
    for (int i = 0; i < n; ++i)
        samples.push_back(
            {film_mm, {float(hash_uniform(1, i)), float(hash_uniform(2, i))}, time, 550});
    return samples;
}

std::vector<CameraRay> drawn(const Camera& camera, const std::vector<CameraSample>& samples) {
    std::vector<CameraRay> rays(samples.size());
    generate_rays(camera, samples, rays);
    return rays;
}

double mean_weight(const std::vector<CameraRay>& rays) {
    double sum = 0;
    for (const CameraRay& r : rays) sum += r.weight;
    return sum / double(rays.size());
}

ExactLens focused(double metres, double f_stop = 4) {
    ExactLensSettings settings;
    settings.f_stop = f_stop, settings.focus_distance_m = metres;
    return {test::check_lens(false, 0.5), settings};
}

}  // namespace

TEST_CASE("a pinhole zooms evenly between its keys") {
    Camera camera{Motion{}, Pinhole{40}};
    camera.lens_motion = {{0.2f, 0.6f}, {Pinhole{30}, Pinhole{50}}};
    struct Case { float time, film; };
    for (const Case c : {Case{0, 30}, {0.3f, 35}, {0.5f, 45}, {0.9f, 50}}) {
        const CameraRay ray = drawn(camera, samples_at(c.time, 1))[0];
        CHECK(ray.ray.direction.x / -ray.ray.direction.z == doctest::Approx(3 / c.film));
        CHECK(ray.weight == 1);
    }
}

TEST_CASE("a thin lens that opens and focuses is at each time the lens in between") {
    const ThinLens from{50, 4, 1, Iris::polygon(5, 0, 0), false},
        to{60, 12, 4, Iris::polygon(5, 30, 0), false}, middle{55, 8, 1.6, {}, false};
    Camera camera{Motion{}, middle};
    camera.lens_motion = {{0, 1}, {from, to}};
    for (const float t : {0.f, 0.25f, 0.75f, 1.f}) {
        ThinLens now{50 + 10 * t, 4 + 8 * t, 1 / (1 - 0.75 * t), t < 0.5f ? from.iris : to.iris, false};
        const auto samples = samples_at(t, 50);
        const auto rays = drawn(camera, samples), expected = drawn({Motion{}, now}, samples);
        const double cone = now.aperture_radius_mm / now.film_distance_mm / (8 / 55.0);
        for (int i = 0; i < 50; ++i) {
            CHECK(length(rays[i].ray.origin - expected[i].ray.origin) < 1e-7f);
            CHECK(length(rays[i].ray.direction - expected[i].ray.direction) < 1e-6f);
            CHECK(rays[i].weight == doctest::Approx(expected[i].weight * cone * cone));
        }
    }
}

TEST_CASE("a projection that zooms, shifts and opens is at each time the one in between") {
    using Kind = ProjectionModel::Kind;
    const ProjectionModel weak(Kind::opencv, {-0.1, 0.02}), strong(Kind::opencv, {-0.2, 0.05});
    const Iris corner = Iris::polygon(5, 0, 0), turned = Iris::polygon(5, 30, 0);
    const Projection from{weak, {30, 31}, {1, -1}, 4, 1, corner}, to{strong, {40, 45}, {2, 3}, 8, 4, turned},
        middle{weak, {35, 38}, {1.5, 1}, 6, 1.6};
    Camera camera{Motion{}, middle};
    camera.lens_motion = {{0, 1}, {from, to}};
    for (const float t : {0.f, 0.25f, 0.75f, 1.f}) {
        const Projection now{t < 0.5f ? weak : strong, {30 + 10 * t, 31 + 14 * t}, {1 + t, -1 + 4 * t},
                             4 + 4 * t,                1 / (1 - 0.75 * t),         t < 0.5f ? corner : turned};
        const auto samples = samples_at(t, 50);
        const auto rays = drawn(camera, samples), expected = drawn({Motion{}, now}, samples);
        const double cone = now.aperture_radius_mm * now.aperture_radius_mm / (now.focal_mm.x * now.focal_mm.y);
        const double light = cone / (36 / (35.0 * 38));
        std::vector<Reprojection> back(50);
        reproject(camera, rays, std::vector<float>(50, 550.f), back);
        for (int i = 0; i < 50; ++i) {
            CHECK(length(rays[i].ray.origin - expected[i].ray.origin) < 1e-7f);
            CHECK(length(rays[i].ray.direction - expected[i].ray.direction) < 1e-6f);
            CHECK(rays[i].weight == doctest::Approx(expected[i].weight * light));
            if (rays[i].weight > 0) CHECK(length(back[i].film_mm - Vec2f{3, 2}) < 1e-4f);
        }
    }
}

TEST_CASE("an exact lens takes the nearest of its states, and the film stays where it is") {
    const ExactLens near = focused(0.6), far = focused(5), middle = focused(1.2);
    Camera camera{Motion{}, middle};
    camera.lens_motion = {{0.25f, 0.75f}, {near.in_the_body_of(middle), far.in_the_body_of(middle)}};
    std::vector<CameraSample> mixed;
    for (int i = 0; i < 300; ++i) mixed.push_back(samples_at(float(i % 7) / 6, 300)[i]);
    const auto rays = drawn(camera, mixed);
    for (int i = 0; i < 300; ++i) {
        const ExactLens& lens = mixed[i].time < 0.5f ? near : far;
        const CameraRay alone = drawn({Motion{}, lens}, {mixed[i]})[0];
        if (mixed[i].time == 0.5f) continue;
        CHECK(length(rays[i].ray.direction - alone.ray.direction) < 1e-7f);
        CHECK(rays[i].weight == doctest::Approx(alone.weight * lens.h0() / middle.h0()).epsilon(1e-5));
        // Distance from film to front vertex: equal in both, measured from the film of the middle
        // state.
        const double film = (middle.film_z_mm() - middle.first_order().entrance_pupil_z) * 1e-3;
        const double own = (lens.film_z_mm() - lens.first_order().entrance_pupil_z) * 1e-3;
        CHECK(film - rays[i].ray.origin.z == doctest::Approx(own - alone.ray.origin.z).epsilon(1e-6));
    }
}

TEST_CASE("wavelengths come back to the film through the state of their time") {
    const ExactLens near = focused(0.6), far = focused(5), middle = focused(1.2);
    Camera camera{Motion{}, middle};
    camera.lens_motion = {{0, 1}, {near.in_the_body_of(middle), far.in_the_body_of(middle)}};
    auto samples = samples_at(0, 100);
    for (int i = 0; i < 100; i += 2) samples[i].time = 1;
    const auto rays = drawn(camera, samples);
    std::vector<Reprojection> back(100);
    reproject(camera, rays, std::vector<float>(100, 550.f), back);
    for (int i = 0; i < 100; ++i) {
        if (rays[i].weight <= 0) continue;
        CHECK(length(back[i].film_mm - Vec2f{3, 2}) < 2e-3f);
        CHECK(back[i].aim_weight == doctest::Approx(rays[i].aim_weight).epsilon(0.01));
    }
}

TEST_CASE("an iris that closes within an exact lens exposes as its f-stop then") {
    const ExactLens wide = focused(2, 4), middle = focused(2, 5.6);
    Camera camera{Motion{}, middle};
    camera.lens_motion = {{0}, {wide.in_the_body_of(middle)}};
    auto samples = samples_at(0.5f, 20000, {0, 0});
    for (CameraSample& s : samples) s.iris_opening = 4 / 8.f;
    const double expected = focused(2, 8).h0() / middle.h0();
    CHECK(mean_weight(drawn(camera, samples)) == doctest::Approx(expected).epsilon(0.02));
}

}  // namespace dg
