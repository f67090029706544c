#include "camera/inverse/chief.h"

#include <doctest/doctest.h>

#include "math/hash.h"
#include "optics/lens/test_lenses.h"

namespace dg {
namespace {

constexpr double kPixelMm = 0.006;

/// Largest distance (px) between film points and their images under the inverse, by way of points
/// at `distance` m along their chief rays. `slip` moves those points sideways (planted fault).
double round_trip(const LensKind& lens, double half_diagonal, double distance,
                  double slip = 0) {
    const ChiefRays chief(lens);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const double r = half_diagonal * std::sqrt(hash_uniform(1, i)),
                     a = 6.3 * hash_uniform(2, i);
        const Vec2d film{r * std::cos(a), r * std::sin(a)};
        const ChiefRay ray = chief.at(film);
        const auto back =
            chief.film_point(ray.origin + ray.direction * distance + Vec3d{slip, 0, 0});
        worst = std::max(worst, back ? length(*back - film) / kPixelMm : 1e9);
    }
    return worst;
}

ExactLens focused(const Prescription& lens, double f_stop, double metres,
                  const Iris& iris = {}) {
    return {lens, {f_stop, iris, metres, FocusFrom::pupil, 21.64}};
}

}  // namespace

TEST_CASE("film point of chief ray of film point is the film point, to 1e-3 px") {
    const std::vector<LensKind> lenses{
        Pinhole{50, false}, ThinLens{50, 12.5, 2, {}, false},
        focused(test::tessar(), 4, 2), focused(test::check_lens(false, 0.5), 2.1, 5),
        focused(test::tessar(), 2.8, 1, Iris::polygon(5, 20, 0))};
    for (const LensKind& lens : lenses)
        for (const double metres : {0.3, 2.0, 1e4}) {
            CHECK(round_trip(lens, 21.6, metres) < 1e-3);
            CHECK(round_trip(lens, 21.6, metres, 1e-6 * metres) > 1e-3);
        }
}

TEST_CASE("points behind the camera have no film point, points at infinity have one") {
    const LensKind lenses[] = {Pinhole{50, false}, focused(test::tessar(), 4, 2)};
    for (const LensKind& lens : lenses) {
        const ChiefRays chief(lens);
        CHECK(!chief.film_point({0.1, 0.2, 1}));
        CHECK(!chief.film_point({0, 0, 1}));
        CHECK(!chief.film_point({0.3, -0.2, 1}, 0));
        const ChiefRay ray = chief.at({10, -7});
        CHECK(length(*chief.film_point(ray.direction, 0) - Vec2d{10, -7}) < 1e-6);
        const auto far = chief.film_point(ray.origin + ray.direction * 1e7);
        CHECK(length(*far - *chief.film_point(ray.direction, 0)) < 1e-6);
    }
}

TEST_CASE(
    "beyond what the lens draws film points go on, past the frame's edge and in order") {
    const ChiefRays chief(focused(test::tessar(), 4, 2));
    double before = 0;
    for (double x = 0.05; x < 1.6; x += 0.05) {
        const auto film = chief.film_point({x, 0, -2});
        if (x < 1) REQUIRE(film);
        if (!film) break;
        CHECK(film->x > before);
        before = film->x;
    }
    CHECK(before > 25);
}

TEST_CASE("a chief ray goes through the point in focus, where the lens's rays meet") {
    const double metres = 2;
    const ExactLens lens = focused(test::check_lens(false, 0.5), 2.8, metres);
    const ChiefRays chief(lens);
    for (const double x : {3.0, 9.0, 15.0}) {
        std::vector<CameraSample> samples;
        for (int i = 0; i < 1 << 16; ++i)  // stratified: the spot is some px wide
            samples.push_back(
                {{float(x), 0},
                 {(float(i % 256) + 0.5f) / 256, (float(i >> 8) + 0.5f) / 256},
                 0,
                 float(kDesignWavelength)});
        std::vector<CameraRay> rays(samples.size());
        lens.generate(samples, rays);
        double sum = 0, weights = 0;
        for (const CameraRay& r : rays) {
            const double t = (-metres - r.ray.origin.z) / r.ray.direction.z;
            sum += r.weight * (r.ray.origin.x + t * r.ray.direction.x),
                weights += r.weight;
        }
        const ChiefRay ray = chief.at({x, 0});
        const double t = (-metres - ray.origin.z) / ray.direction.z;
        const double pixel_m = kPixelMm * metres / 50;
        CHECK(std::abs(ray.origin.x + t * ray.direction.x - sum / weights) <
              0.1 * pixel_m);
    }
}

TEST_CASE("copies of a lens share its chief rays, other lenses have their own") {
    const ExactLens lens = focused(test::tessar(), 4, 2);
    const auto kept = [](const ExactLens& of) { return &of.chief_rays().get([] { return ChiefRays(Pinhole{}); }); };
    const ChiefRays first(lens);
    const LensKind copy = lens;
    CHECK(kept(std::get<ExactLens>(copy)) == kept(lens));
    CHECK(ChiefRays(copy).at({10, -7}).direction == first.at({10, -7}).direction);
    const ExactLens body = focused(test::tessar(), 4, 0.6).in_the_body_of(lens);
    const ExactLens fresh = focused(test::tessar(), 4, 0.6);
    CHECK(length(ChiefRays(body).at({10, -7}).origin - ChiefRays(fresh).at({10, -7}).origin) > 1e-4);
    LensDirt half;   // a front that is dark on one side shifts the mean ray
    half.front = {2, 1, {0, 1}};
    const ExactLens dirty = lens.with_dirt(half);
    CHECK(kept(dirty) != kept(lens));
    CHECK(kept(lens.without_fit()) == kept(lens));
}

}  // namespace dg
