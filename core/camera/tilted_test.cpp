#include <doctest/doctest.h>

#include <random>

#include "camera/exact.h"
#include "math/statistics.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

constexpr double kDegree = kPiD / 180;

struct Estimate {
    double mean = 0, variance = 0, pass = 0;
};

Estimate estimate(double sum, double squares, double passed, double count) {
    const double mean = sum / count;
    return {mean, (squares / count - mean * mean) / (count - 1), passed / count};
}

ExactLensSettings tilted(double f_stop, Vec2d tilt_deg, const Iris& iris = {}) {
    ExactLensSettings s;
    s.f_stop = f_stop, s.iris = iris, s.focus_distance_m = 3, s.tilt_deg = tilt_deg;
    s.film_half_mm = {18, 12};
    return s;
}

Estimate drawn(const ExactLens& lens, Vec2d film, double nm, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(0, 1);
    std::vector<CameraSample> samples(count);
    std::vector<CameraRay> rays(count);
    for (CameraSample& s : samples)
        s = {{float(film.x), float(film.y)}, {u(random), u(random)}, 0, float(nm)};
    lens.generate(samples, rays);
    double sum = 0, squares = 0, passed = 0;
    for (const CameraRay& r : rays) {
        const double w = r.weight * lens.h0();
        sum += w, squares += w * w, passed += w > 0;
    }
    return estimate(sum, squares, passed, count);
}

/// Rotation of a tilt, independent of the code under test: about x, then about y; rows of
/// camera_from_lens.
struct Rotation {
    double row[3][3];
    explicit Rotation(Vec2d deg) {
        const double ca = std::cos(deg.x * kDegree), sa = std::sin(deg.x * kDegree);
        const double cb = std::cos(deg.y * kDegree), sb = std::sin(deg.y * kDegree);
        const double r[3][3] = {{cb, sb * sa, sb * ca}, {0, ca, -sa}, {-sb, cb * sa, cb * ca}};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) row[i][k] = r[i][k];
    }
    Vec3d to_lens(Vec3d v) const {
        Vec3d o{};
        for (int k = 0; k < 3; ++k) o[k] = row[0][k] * v.x + row[1][k] * v.y + row[2][k] * v.z;
        return o;
    }
};

/// Offset of the film's (0, 0) from the camera's axis, mm.
Vec2d middle_of_film(const ExactLens& lens, const Rotation& turn) {
    const Vec3d c = lens.film_plane().center - Vec3d{0, 0, lens.first_order().entrance_pupil_z};
    Vec2d ahead{};
    for (int k = 0; k < 3; ++k) ahead.x += turn.row[0][k] * c[k], ahead.y += turn.row[1][k] * c[k];
    return ahead;
}

/// E / L with points uniform on a disc behind the last surface of the tilted lens, in double: G =
/// cos cos / d^2, with the cosine at the film raised to `film_power`.
Estimate rear_disc(const ExactLens& lens, const ExactLensSettings& s, Vec2d film, double nm,
                   int count, unsigned seed, double film_power = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    const Tracer& tracer = lens.tracer();
    const Rotation turn(s.tilt_deg);
    const double pupil = lens.first_order().entrance_pupil_z;
    const double last = tracer.vertices().back();
    const double disc = 1.25 * tracer.prescription().surfaces.back().semi_diameter;
    const Vec2d ahead = middle_of_film(lens, turn);
    const Vec3d normal = turn.to_lens({0, 0, 1});
    Vec3d from = turn.to_lens(
        {ahead.x - film.x, ahead.y - film.y, (lens.film_z_mm() - pupil) * normal.z});
    from.z += pupil;
    const LensIndices n = tracer.at(nm);
    const Clip clip{true, &s.iris, lens.iris_radius_mm()};
    double sum = 0, squares = 0, passed = 0;
    for (int i = 0; i < count; ++i) {
        const Vec2d p = disc * concentric_disc({u(random), u(random)});
        const Vec3d way = Vec3d{p.x, p.y, last} - from;
        const double d2 = dot(way, way);
        const Vec3d d = way * (1 / std::sqrt(d2));
        const auto ray = tracer.to_scene({from, d}, n, clip);
        const double w = ray ? ray->transmittance * std::pow(-dot(d, normal), film_power) * -d.z *
                                   kPiD * disc * disc / d2
                             : 0;
        sum += w, squares += w * w, passed += w > 0;
    }
    return estimate(sum, squares, passed, count);
}

double z_score(const Estimate& a, const Estimate& b) {
    const double variance = a.variance + b.variance;
    return variance > 0 ? (a.mean - b.mean) / std::sqrt(variance) : 0;
}

bool accepted(const std::vector<double>& scores, double alpha) {
    double squares = 0, worst = 0;
    for (const double z : scores) squares += z * z, worst = std::max(worst, std::abs(z));
    const double n = double(scores.size());
    return 2 * normal_cdf(-worst) > sidak_level(alpha, n) && chi_square_tail(squares, n) > alpha;
}

}  // namespace

TEST_CASE("tilted: guided = boxes = rear disc in double; a cosine that is missing is caught") {
    std::vector<double> guided, boxed, no_cosine;
    unsigned seed = 1;
    for (const Prescription& prescription : test::all_lenses())
        for (const Vec2d tilt : {Vec2d{6, 0}, Vec2d{-3, 8}})
            for (const double stops : {1.0, 2.8}) {
                if (tilt.y != 0 && stops > 1) continue;
                const ExactLensSettings s =
                    tilted(first_order(prescription).f_number * stops, tilt);
                ExactLensSettings box_settings = s;
                box_settings.draw = PupilDraw::slope_boxes;
                const ExactLens lens(prescription, s), box(prescription, box_settings);
                const double nm[] = {400, 550, 720};
                for (const Vec2d film : {Vec2d{0, 0}, Vec2d{11, -8}, Vec2d{-16, 3}}) {
                    ++seed;
                    const Estimate r =
                        rear_disc(lens, s, film, nm[seed % 3], 1 << 13, seed);
                    const Estimate g = drawn(lens, film, nm[seed % 3], 1 << 13, seed);
                    CHECK((g.mean > 0) == (r.mean > 0));
                    if (!(r.mean > 0)) continue;
                    guided.push_back(z_score(g, r));
                    boxed.push_back(
                        z_score(drawn(box, film, nm[seed % 3], 1 << 13, seed), r));
                    no_cosine.push_back(z_score(
                        g, rear_disc(lens, s, film, nm[seed % 3], 1 << 13, seed, 0)));
                }
            }
    CHECK(guided.size() > 45);
    CHECK(accepted(guided, 1e-3));
    CHECK(accepted(boxed, 1e-3));
    CHECK_FALSE(accepted(no_cosine, 1e-3));
}

TEST_CASE("tilted: the lens's axis meets the film where it was, and the middle looks straight ahead") {
    for (const Prescription& prescription : test::all_lenses()) {
        const Vec2d tilt{-4, 6};
        const ExactLens lens(prescription, tilted(4 * first_order(prescription).f_number, tilt));
        const FilmPlane film = lens.film_plane();
        CHECK(std::abs(dot(Vec3d{0, 0, lens.film_z_mm()} - film.center, film.normal())) < 1e-9);
        CHECK(length(film.normal() - Rotation(tilt).to_lens({0, 0, 1})) < 1e-12);
        CHECK(length(lens.chief_direction({0, 0}) - Vec3d{0, 0, -1}) < 0.004);
        CHECK(lens.h0() > 0);
    }
}

TEST_CASE("tilted: rays lead back to their film points with their weights") {
    const ExactLens lens(test::check_lens(true, 0.5), tilted(2.8, {5, -4}));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(0, 1);
    std::vector<CameraSample> samples(3000);
    for (CameraSample& s : samples)
        s = {{34 * u(random) - 17, 22 * u(random) - 11}, {u(random), u(random)}, 0,
             380 + 400 * u(random)};
    std::vector<CameraRay> rays(samples.size());
    lens.generate(samples, rays);
    std::vector<float> nm;
    for (const CameraSample& s : samples) nm.push_back(s.wavelength_nm);
    std::vector<Reprojection> same(samples.size());
    lens.reproject(rays, nm, same);
    int passed = 0, lost = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (rays[i].weight <= 0) continue;
        ++passed;
        if (same[i].aim_weight == 0) {
            ++lost;   // grazes an edge
            continue;
        }
        CHECK(length(same[i].film_mm - samples[i].film_mm) < 3e-3);
        CHECK(same[i].aim_weight == doctest::Approx(rays[i].aim_weight).epsilon(1e-3));
    }
    CHECK(passed > 1500);
    CHECK(lost < passed / 300 + 2);
}

// Scheimpflug: the planes of film, lens and sharp focus intersect in a line. With the lens rotated
// by t about y of the pupil, a thin lens's plane of focus tilts by atan(tan(t) s'' / f). The exact
// lens is compared where it is sharp, within its aberrations.
TEST_CASE("tilted: the plane of focus leans as Scheimpflug's rule says") {
    const double tilt = 4;
    ExactLensSettings s = tilted(8, {0, tilt});
    const ExactLens lens(test::check_lens(true, 0.5), s);
    const FirstOrder& order = lens.first_order();
    // Narrowest point of the pencil of a film point, in the camera frame.
    const auto sharpest = [&](double x) {
        std::vector<CameraSample> samples;
        for (int i = 0; i < 4096; ++i)
            samples.push_back({{float(x), 0},
                               {(i % 64 + 0.5f) / 64, (float(i / 64) + 0.5f) / 64},
                               0,
                               float(kDesignWavelength)});
        std::vector<CameraRay> rays(samples.size());
        lens.generate(samples, rays);
        double best = 1e30, at = 0, where = 0;
        for (double z = -1.5; z > -8; z -= 0.01) {
            double sum = 0, squares = 0, n = 0;
            for (const CameraRay& r : rays) {
                if (!(r.weight > 0)) continue;
                const double t = (z - r.ray.origin.z) / r.ray.direction.z;
                const double h = r.ray.origin.x + t * r.ray.direction.x;
                sum += h, squares += h * h, n += 1;
            }
            // Angular width as seen from the lens.
            const double width = std::sqrt(squares / n - sum / n * (sum / n)) / -z;
            if (width < best) best = width, at = z, where = sum / n;
        }
        return Vec2d{where, at};
    };
    const Vec2d a = sharpest(-4), b = sharpest(4);
    // The film plane is imaged through the tilted lens by collinear imaging (principal planes,
    // Newton): images of two film points in the lens frame, and the line between them.
    const auto image = [&](double x) {
        const double c = std::cos(tilt * kDegree), si = std::sin(tilt * kDegree);
        const double depth = (lens.film_z_mm() - order.entrance_pupil_z) * c;
        const double at = middle_of_film(lens, Rotation({0, tilt})).x - x;
        const double lx = c * at - si * depth, lz = si * at + c * depth + order.entrance_pupil_z;
        const double x_image = lz - order.back_focal_z;   // Newton: x x' = f^2
        const double z = order.front_focal_z - order.efl * order.efl / x_image;
        const double h = lx * -order.efl / x_image;
        const double dz = z - order.entrance_pupil_z;
        return Vec2d{c * h + si * dz, -si * h + c * dz} * 1e-3;
    };
    const Vec2d pa = image(-4), pb = image(4);
    const double lean = (b.y - a.y) / (b.x - a.x), expected = (pb.y - pa.y) / (pb.x - pa.x);
    CHECK(std::abs(expected) > 2);
    CHECK(lean == doctest::Approx(expected).epsilon(0.08));
}
