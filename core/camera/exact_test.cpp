#include "camera/exact.h"

#include <doctest/doctest.h>

#include <memory>
#include <random>

#include "math/error.h"
#include "math/statistics.h"
#include "optics/lens/test_lenses.h"
#include "spectrum/wavelengths.h"

using namespace dg;

namespace {

struct Estimate {
    double mean = 0, variance = 0;  // variance of the mean
    double pass = 0;
};

/// E / L at a film point, including T, by the lens's sampler.
Estimate drawn(const ExactLens& lens, double radius, double nm, int count,
               unsigned seed, float opening = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(0, 1);
    std::vector<CameraSample> samples(count);
    std::vector<CameraRay> rays(count);
    for (CameraSample& s : samples)
        s = {{float(0.8 * radius), float(-0.6 * radius)},
             {u(random), u(random)},
             0,
             float(nm),
             opening};
    lens.generate(samples, rays);
    double sum = 0, squares = 0, pass = 0;
    for (const CameraRay& r : rays) {
        const double w = r.weight * lens.h0();
        sum += w, squares += w * w, pass += w > 0;
    }
    const double mean = sum / count;
    return {mean, (squares / count - mean * mean) / (count - 1), pass / count};
}

/// E / L without importance sampling: points uniform on a disc behind the last surface. `power` of
/// 1 / (1+m^2): 2 is right, 1.5 omits the cosine.
Estimate rear_disc(const ExactLens& lens, double radius, double nm, int count,
                   unsigned seed, double power = 2) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    const auto& surfaces = lens.tracer().prescription().surfaces;
    const double last = lens.tracer().vertices().back();
    const double gap = lens.film_z_mm() - last,
                 disc = 1.25 * surfaces.back().semi_diameter;
    auto film = std::make_unique<FilmRays>();
    auto scene = std::make_unique<SceneRays>();
    const double x = -0.8 * radius, y = 0.6 * radius;
    double sum = 0, squares = 0, pass = 0;
    for (int n = 0; n < count; n += kLensBatch) {
        for (int i = 0; i < kLensBatch; ++i) {
            const Vec2d p = disc * concentric_disc({u(random), u(random)});
            film->x[i] = float(x), film->y[i] = float(y), film->nm[i] = float(nm);
            film->mx[i] = float((x - p.x) / gap), film->my[i] = float((y - p.y) / gap);
        }
        trace_to_scene(lens.tables(), *film, *scene, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) {
            const double m2 = film->mx[i] * film->mx[i] + film->my[i] * film->my[i];
            const double w =
                kPiD * disc * disc / (gap * gap) *
                (scene->pass[i] > 0 ? std::pow(1 + m2, -power) * scene->pass[i] : 0);
            sum += w, squares += w * w, pass += w > 0;
        }
    }
    const double mean = sum / count;
    return {mean, (squares / count - mean * mean) / (count - 1), pass / count};
}

double z_score(const Estimate& a, const Estimate& b, double fault = 1) {
    const double variance = a.variance * fault * fault + b.variance;
    return variance > 0 ? (a.mean * fault - b.mean) / std::sqrt(variance) : 0;
}

ExactLensSettings at(double f_stop, const Iris& iris = {}, double focus_m = 3) {
    return {f_stop, iris, focus_m, FocusFrom::pupil, 21.64};
}

/// Tests the largest z score of a family and the sum of squares, each at significance `alpha`.
bool accepted(const std::vector<double>& scores, double alpha) {
    double squares = 0, worst = 0;
    for (const double z : scores) squares += z * z, worst = std::max(worst, std::abs(z));
    const double n = double(scores.size());
    return 2 * normal_cdf(-worst) > sidak_level(alpha, n) &&
           chi_square_tail(squares, n) > alpha;
}

}  // namespace

TEST_CASE(
    "check lens: E/L on the axis is pi sin^2(theta') = 0.19247, by quadrature and by "
    "drawing") {
    Prescription lens = test::check_lens();
    lens.coating = Coating::perfect;
    const Tracer t(lens);
    const double film = lens.last_vertex() + 72.228;
    const double e =
        axial_irradiance(t, film, RadialOpening(Iris()), 17.1, kDesignWavelength, true);
    CHECK(e == doctest::Approx(0.19247).epsilon(3e-5));
    // Guided estimator with the same film position and iris.
    const AimRequest request{film, 22, Iris(), 17.1};
    const Aim aim = make_aim(t, request);
    const LensTables tables = make_lens_tables(t, film, true, &request.iris, 17.1);
    auto in = std::make_unique<LensSamples>();
    auto out = std::make_unique<SceneRays>();
    alignas(64) float weight[kLensBatch];
    std::mt19937 random(1);
    std::uniform_real_distribution<float> u(0, 1);
    double sum = 0;
    constexpr int kBatches = 4000;
    for (int n = 0; n < kBatches; ++n) {
        for (int i = 0; i < kLensBatch; ++i) {
            in->x[i] = in->y[i] = 0, in->nm[i] = float(kDesignWavelength);
            in->u[i] = u(random), in->v[i] = u(random);
        }
        guided_rays(tables, aim.tables, *in, *out, weight, nullptr, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) sum += weight[i] * out->pass[i];
    }
    CHECK(sum / (double(kBatches) * kLensBatch) ==
          doctest::Approx(0.19247).epsilon(1e-3));
}

TEST_CASE("the exposure of the axis from few rays is that from many, coatings and blades included") {
    for (const Prescription& prescription : test::all_lenses())
        for (const Iris& iris : {Iris(), Iris::polygon(5, 7, 0)})
            for (const double f_number : {1.0, 4.0}) {
                const FirstOrder order = first_order(prescription);
                const double radius = iris_radius(prescription, order, order.f_number * f_number);
                const ExactLens lens(prescription, at(order.f_number * f_number));
                const Tracer& t = lens.tracer();
                const RadialOpening opening(iris);
                const LensIndices n = t.at(450);
                const double e =
                    axial_irradiance(t, lens.film_z_mm(), opening, radius, 450);
                // Brute force over all directions, beyond the passing cone.
                constexpr int kMany = 8000;
                const double outer = 4 * e / kPiD;
                double sum = 0;
                for (int i = 0; i < kMany; ++i) {
                    const double s2 = outer * (i + 0.5) / kMany;
                    const auto ray = t.to_scene({{0, 0, lens.film_z_mm()},
                                                 {-std::sqrt(s2), 0, -std::sqrt(1 - s2)}},
                                                t.at(450), {true, nullptr, 0});
                    if (ray)
                        sum += ray->transmittance * opening.at(std::abs(ray->iris.x) / radius);
                }
                CHECK(e == doctest::Approx(kPiD * outer * sum / kMany).epsilon(3e-4));
            }
}

TEST_CASE(
    "guided = rear disc = exit-pupil box; a 2 % pdf or a dropped cosine is caught") {
    std::vector<double> guided, boxed, two_percent, no_cosine;
    unsigned seed = 1;
    for (const Prescription& prescription : test::all_lenses()) {
        const double widest = first_order(prescription).f_number;
        for (const double stops : {1.0, 2.0, 4.0}) {
            const ExactLens lens(prescription, at(widest * stops));
            ExactLensSettings box_settings = at(widest * stops);
            box_settings.draw = PupilDraw::slope_boxes;
            const ExactLens box(prescription, box_settings);
            const double wavelengths[] = {400, 550, 720};
            for (int i = 0; i < 5; ++i) {
                const double radius = 5.2 * i, nm = wavelengths[seed % 3];
                const Estimate reference = rear_disc(lens, radius, nm, 1 << 16, ++seed);
                const Estimate g = drawn(lens, radius, nm, 1 << 14, ++seed);
                const Estimate b = drawn(box, radius, nm, 1 << 14, ++seed);
                // The guided estimator must see light exactly where the reference does.
                CHECK((g.mean > 0) == (reference.mean > 0));
                if (reference.mean == 0) continue;
                guided.push_back(z_score(g, reference));
                boxed.push_back(z_score(b, reference));
                two_percent.push_back(z_score(g, reference, 1.02));
                no_cosine.push_back(
                    z_score(g, rear_disc(lens, radius, nm, 1 << 15, seed, 1.5)));
            }
        }
    }
    CHECK(guided.size() > 70);
    CHECK(accepted(guided, 1e-3));
    CHECK(accepted(boxed, 1e-3));
    CHECK_FALSE(accepted(two_percent, 1e-3));
    CHECK_FALSE(accepted(no_cosine, 1e-3));
}

TEST_CASE("guided rays mostly pass: 98 % stopped down, most of them wide open") {
    const Prescription gauss = test::check_lens(true, 0.5);
    const ExactLens open(gauss, at(2.02)), small(gauss, at(8));
    CHECK(drawn(small, 0, 550, 1 << 14, 1).pass > 0.975);
    CHECK(drawn(small, 18, 550, 1 << 14, 2).pass > 0.97);
    CHECK(drawn(open, 0, 550, 1 << 14, 3).pass > 0.9);
    CHECK(drawn(open, 20, 550, 1 << 14, 4).pass > 0.5);
}

TEST_CASE("a white D65 world has mean weight 1 on the axis") {
    for (const Prescription& prescription : test::all_lenses())
        for (const Iris& iris : {Iris(), Iris::polygon(5, 0, 0)}) {
            const ExactLens lens(prescription,
                                 at(2 * first_order(prescription).f_number, iris));
            double sum = 0, weights = 0;
            for (double nm = 395; nm <= 765; nm += 10) {
                const double w = cie_y(nm) * d65(nm);
                sum += w * drawn(lens, 0, nm, 4096, unsigned(nm)).mean / lens.h0();
                weights += w;
            }
            CHECK(sum / weights == doctest::Approx(1).epsilon(2e-3));
        }
}

TEST_CASE("one stop halves the exposure; the number of blades does not change it") {
    const Prescription gauss = test::check_lens(true, 0.5);
    const double e4 = ExactLens(gauss, at(4)).h0();
    CHECK(ExactLens(gauss, at(4 * std::sqrt(2.0))).h0() / e4 ==
          doctest::Approx(0.5).epsilon(0.004));
    CHECK(ExactLens(gauss, at(8)).h0() / e4 == doctest::Approx(0.25).epsilon(0.004));
    for (const Iris& iris :
         {Iris::polygon(3, 0, 0), Iris::polygon(5, 12, 0), Iris::polygon(8, 0, 0),
          Iris::polygon(7, 0, 0.8), Iris::polygon(6, 0, -0.5)}) {
        const ExactLens lens(gauss, at(4, iris));
        CHECK(lens.h0() / e4 == doctest::Approx(1).epsilon(1e-3));
        CHECK(drawn(lens, 0, 550, 1 << 15, 9).mean ==
              doctest::Approx(drawn(ExactLens(gauss, at(4)), 0, 550, 1 << 15, 10).mean)
                  .epsilon(4e-3));
    }
}

TEST_CASE("a leaf that is open to half its radius exposes as two stops less") {
    for (const Iris& iris : {Iris(), Iris::polygon(6, 10, 0.3), Iris::polygon(5, 0, -0.4)}) {
        const auto at_stop = [&](double f_stop) {
            ExactLensSettings settings;
            settings.f_stop = f_stop, settings.iris = iris;
            return ExactLens(test::check_lens(), settings);
        };
        const ExactLens open = at_stop(4), closed = at_stop(8);
        for (const double radius : {0.0, 12.0}) {
            const Estimate leaf = drawn(open, radius, 550, 60000, 1, 0.5f);
            const Estimate stop = drawn(closed, radius, 550, 60000, 2);
            const double sigma = std::sqrt(leaf.variance + stop.variance);
            CHECK(std::abs(leaf.mean - stop.mean) < 4 * sigma);
            CHECK(sigma < 0.01 * stop.mean);
        }
        CHECK(drawn(open, 5, 550, 1000, 1, 0.f).mean == 0);
    }
}

TEST_CASE("wavelengths are stopped by the leaf on their way back, too") {
    ExactLensSettings settings;
    settings.f_stop = 2.8;
    const ExactLens lens(test::check_lens(), settings);
    std::vector<CameraSample> samples;
    for (int i = 0; i < 400; ++i)
        samples.push_back({{3, 2}, {(i % 20 + 0.5f) / 20, (i / 20 + 0.5f) / 20}, 0, 500, 0.6f});
    std::vector<CameraRay> rays(400);
    lens.generate(samples, rays);
    std::vector<Reprojection> back(400);
    const std::vector<float> same(400, 500.f);
    lens.reproject(rays, same, back);
    int passed = 0;
    for (int i = 0; i < 400; ++i) passed += rays[i].weight > 0 && back[i].aim_weight > 0;
    CHECK(passed > 120);   // 0.36 of the sampled rays
    for (CameraRay& r : rays) r.iris_opening = 0.4f;
    lens.reproject(rays, same, back);
    int fewer = 0;
    for (int i = 0; i < 400; ++i) fewer += rays[i].weight > 0 && back[i].aim_weight > 0;
    CHECK(fewer == doctest::Approx(passed * 0.16 / 0.36).epsilon(0.15));
}

TEST_CASE("uncoated, coated and perfect lenses differ by their transmittance") {
    Prescription lens = test::check_lens(true, 0.5);
    const auto transmittance = [&](Coating c) {
        lens.coating = c;
        return ExactLens(lens, at(4)).transmittance();
    };
    CHECK(transmittance(Coating::perfect) == 1);
    // Eight air-glass surfaces of n = 1.60 to 1.72 and two cemented surfaces.
    CHECK(transmittance(Coating::uncoated) == doctest::Approx(0.585).epsilon(0.02));
    CHECK(transmittance(Coating::mgf2) > 0.93);
}

TEST_CASE("the picture is upright and sharp where it is focused") {
    const Prescription gauss = test::check_lens(true, 0.5);
    const ExactLens lens(gauss, at(8, {}, 2));
    std::mt19937 random(4);
    std::uniform_real_distribution<float> u(0, 1);
    for (const Vec2f film : {Vec2f{3, 0}, Vec2f{0, 5}, Vec2f{-4, 2}}) {
        std::vector<CameraSample> samples(512, CameraSample{film, {}, 0.25f, 550});
        for (CameraSample& s : samples) s.u_lens = {u(random), u(random)};
        std::vector<CameraRay> rays(samples.size());
        lens.generate(samples, rays);
        // On the focal plane, 2 m in front of the pupil, the rays meet: paraxially at -film /
        // magnification.
        const double scale = 2e3 / lens.film_distance_mm();
        for (const CameraRay& r : rays) {
            if (r.weight <= 0) continue;
            const float t = (-2 - r.ray.origin.z) / r.ray.direction.z;
            const Vec3f p = r.ray.origin + t * r.ray.direction;
            CHECK(p.x * 1e3 == doctest::Approx(film.x * scale).epsilon(0.05).scale(20));
            CHECK(p.y * 1e3 == doctest::Approx(film.y * scale).epsilon(0.05).scale(20));
            CHECK(r.ray.time == 0.25f);
            CHECK(length(r.ray.direction) == doctest::Approx(1).epsilon(1e-5));
        }
        const Vec3d chief = lens.chief_direction({film.x, film.y});
        CHECK(chief.z < -0.9);
        CHECK(chief.x * film.x >= 0);
        CHECK(chief.y * film.y >= 0);
    }
}

TEST_CASE(
    "reprojection at the same wavelength returns film point and weights; others shift "
    "slightly") {
    for (const Prescription& prescription : test::all_lenses()) {
        const ExactLens lens(prescription, at(2 * first_order(prescription).f_number));
        std::mt19937 random(8);
        std::uniform_real_distribution<float> u(0, 1);
        std::vector<CameraSample> samples(3000);
        for (CameraSample& s : samples)
            s = {{30 * u(random) - 15, 20 * u(random) - 10},
                 {u(random), u(random)},
                 0,
                 380 + 400 * u(random)};
        std::vector<CameraRay> rays(samples.size());
        lens.generate(samples, rays);
        std::vector<float> nm(samples.size()), other(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i)
            nm[i] = samples[i].wavelength_nm, other[i] = 550;
        std::vector<Reprojection> same(samples.size()), green(samples.size());
        lens.reproject(rays, nm, same);
        lens.reproject(rays, other, green);
        int passed = 0, lost = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (rays[i].weight <= 0) continue;
            ++passed;
            if (same[i].aim_weight == 0) {
                ++lost;  // grazes an edge
                continue;
            }
            CHECK(length(same[i].film_mm - samples[i].film_mm) < 3e-3);
            CHECK(same[i].aim_weight ==
                  doctest::Approx(rays[i].aim_weight).epsilon(1e-3));
            CHECK(same[i].aim_weight * same[i].transmittance ==
                  doctest::Approx(rays[i].weight).epsilon(1e-3));
            if (green[i].aim_weight > 0)
                CHECK(length(green[i].film_mm - samples[i].film_mm) < 1);
        }
        CHECK(passed > 1000);
        CHECK(lost < passed / 500 + 2);
    }
}

TEST_CASE(
    "film points that the aim was not made for are dark; odd batch sizes are served") {
    const ExactLens lens(test::tessar(), at(4));
    for (const std::size_t count :
         {std::size_t(1), std::size_t(31), std::size_t(257), std::size_t(1000)}) {
        std::vector<CameraSample> samples(count,
                                          CameraSample{{1, 2}, {0.4f, 0.6f}, 0, 500});
        std::vector<CameraRay> rays(count);
        lens.generate(samples, rays);
        for (const CameraRay& r : rays) {
            CHECK(r.weight == rays[0].weight);
            CHECK(r.weight > 0);
            CHECK(r.ray.direction == rays[0].ray.direction);
        }
    }
    std::vector<CameraSample> outside(4, CameraSample{{40, 0}, {0.5f, 0.5f}, 0, 500});
    std::vector<CameraRay> rays(4);
    lens.generate(outside, rays);
    CHECK(rays[0].weight == 0);
}

TEST_CASE("lenses that cannot be used say why") {
    const Prescription gauss = test::check_lens(true, 0.5);
    CHECK_THROWS_WITH_AS(ExactLens(gauss, at(1.2)), doctest::Contains("widest"), Error);
    CHECK_THROWS_WITH_AS(ExactLens(gauss, at(4, {}, 0.01)),
                         doctest::Contains("nearest possible"), Error);
    ExactLensSettings no_film = at(4);
    no_film.half_diagonal_mm = 0;
    CHECK_THROWS_AS(ExactLens(gauss, no_film), Error);
}
