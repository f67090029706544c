// Camera rays and light rays through one lens: the same measure, the same film, the same light.
#include "camera/pupil_view.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "camera/view_cases.h"
#include "math/statistics.h"

using namespace dg;

namespace {

using Random = std::mt19937;
Vec2f square(Random& random) {
    std::uniform_real_distribution<float> u(0, 1);
    const float a = u(random);
    return {a, u(random)};
}

/// A bright square around a point, or (w = 0) of directions; luminance 1.
struct Emitter {
    Vec3d center, x, y, normal;
    double w, half;

    /// `half`: m, or at infinity the tangent of the angle.
    Emitter(Vec3d p, double w, double half, Vec3d facing) : center(w == 0 ? normalize(p) : p), w(w), half(half) {
        normal = normalize(w == 0 ? -center : facing);
        x = normalize(cross(Vec3d{0.3, 1, 0.2}, normal)), y = cross(normal, x);
    }
    Vec3d at(Vec2f u) const {
        return center + x * ((2 * u.x - 1) * half) + y * ((2 * u.y - 1) * half);
    }
    bool meets(const Ray& ray) const {
        const Vec3d d = to_double(ray.direction), o = w == 0 ? Vec3d{} : to_double(ray.origin);
        const double along = dot(d, normal), t = dot(center - o, normal) / along;
        if (!(along < 0 && t > 0)) return false;
        const Vec3d hit = o + d * t - center;
        return std::abs(dot(hit, x)) < half && std::abs(dot(hit, y)) < half;
    }
};

struct Found {
    Vec2f film_mm;
    double light;   // relative exposure x mm2
};

float wavelength(std::size_t i) { return 430.f + 70.f * float(i % 4); }

CameraRay camera_ray(const PupilView::Sample& s, float time, float opening) {
    CameraRay r;
    r.ray = Ray{.origin = s.origin, .direction = s.direction, .time = time};
    r.iris_opening = opening;
    return r;
}

std::vector<Found> by_light(const test::ViewCase& c, const Emitter& e, int count, unsigned seed) {
    Random random(seed);
    const PupilViewOverTime view(c.camera);
    std::vector<CameraRay> rays(count);
    std::vector<float> nm;
    std::vector<Found> found(count);
    for (int i = 0; i < count; ++i) {
        const float time = square(random).x;
        const Vec3d y = e.at(square(random));
        nm.push_back(wavelength(i));
        const auto s = view.sample(y, e.w, square(random), time);
        if (!s) continue;
        rays[i] = camera_ray(*s, time, c.opening);
        const double cosine = -dot(to_double(s->direction), e.normal), side = 2 * e.half;
        // Solid angle of a patch of the square at infinity: cos^3 of its area.
        const double factor = e.w == 0 ? cosine * cosine * cosine : std::max(0.0, cosine);
        found[i].light = side * side * factor / s->pdf;
    }
    std::vector<Reprojection> film(count);
    reproject(c.camera, rays, nm, film);
    for (int i = 0; i < count; ++i) {
        found[i].film_mm = film[i].film_mm;
        found[i].light *= film[i].response;
        if (!(found[i].light > 0) || length(film[i].film_mm) > c.half_diagonal_mm) found[i] = {};
    }
    return found;
}

struct Rectangle {
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};
    double area() const { return double(high.x - low.x) * (high.y - low.y); }
    int cell(Vec2f p, int side) const {
        const float x = (p.x - low.x) / (high.x - low.x), y = (p.y - low.y) / (high.y - low.y);
        if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return -1;
        return int(y * side) * side + int(x * side);
    }
};

Rectangle around(const std::vector<Found>& found) {
    Rectangle r;
    for (const Found& f : found) {
        if (!(f.light > 0)) continue;
        r.low = {std::min(r.low.x, f.film_mm.x), std::min(r.low.y, f.film_mm.y)};
        r.high = {std::max(r.high.x, f.film_mm.x), std::max(r.high.y, f.film_mm.y)};
    }
    return r;
}

std::vector<Found> by_camera(const test::ViewCase& c, const Emitter& e, const Rectangle& film,
                             int count, unsigned seed) {
    Random random(seed);
    std::vector<CameraSample> samples(count);
    std::vector<CameraRay> rays(count);
    std::vector<Found> found(count);
    for (int i = 0; i < count; ++i) {
        const Vec2f u = square(random);
        const Vec2f at{film.low.x + u.x * (film.high.x - film.low.x),
                       film.low.y + u.y * (film.high.y - film.low.y)};
        samples[i] = {at, square(random), square(random).x, wavelength(i), c.opening};
    }
    generate_rays(c.camera, samples, rays);
    for (int i = 0; i < count; ++i)
        if (rays[i].weight > 0 && length(samples[i].film_mm) <= c.half_diagonal_mm && e.meets(rays[i].ray))
            found[i] = {samples[i].film_mm, rays[i].weight * film.area()};
    return found;
}

constexpr int kSide = 3;

std::vector<SampleMoments> per_cell(const std::vector<Found>& found, const Rectangle& film,
                                    double factor = 1) {
    std::vector<double> sum(kSide * kSide + 1), squares(kSide * kSide + 1);
    for (const Found& f : found) {
        const int cell = film.cell(f.film_mm, kSide);
        if (cell < 0 || !(f.light > 0)) continue;
        const double light = factor * f.light;
        for (const int k : {cell, kSide * kSide}) sum[k] += light, squares[k] += light * light;
    }
    std::vector<SampleMoments> m;
    const double n = double(found.size());
    for (std::size_t k = 0; k < sum.size(); ++k)
        m.push_back({sum[k] / n, (squares[k] - sum[k] * sum[k] / n) / (n - 1), n});
    return m;
}

/// Differences of all cells and of their total, in standard errors.
void compare(const std::vector<SampleMoments>& a, const std::vector<SampleMoments>& b,
             std::vector<double>& cells, std::vector<double>& totals) {
    for (std::size_t k = 0; k < a.size(); ++k) {
        // Means of few hits are not normal.
        const auto many = [](const SampleMoments& m) {
            return m.mean * m.mean * m.count > 40 * m.variance;
        };
        if (!many(a[k]) || !many(b[k])) continue;
        const double e2 = a[k].variance / a[k].count + b[k].variance / b[k].count;
        (k + 1 == a.size() ? totals : cells).push_back((a[k].mean - b[k].mean) / std::sqrt(e2));
    }
}

double chi_square_p(const std::vector<double>& z) {
    double sum = 0;
    for (const double s : z) sum += s * s;
    return chi_square_tail(sum, double(z.size()));
}

}  // namespace

TEST_CASE("a ray that the camera draws comes back to its film point with its own weight") {
    for (const test::ViewCase& c : test::view_cases()) {
        CAPTURE(c.name);
        Random random(3);
        const float side = c.half_diagonal_mm * 0.7f;
        std::vector<CameraSample> samples(2000);
        std::vector<float> nm;
        for (CameraSample& s : samples) {
            const Vec2f u = square(random);
            nm.push_back(wavelength(nm.size()));
            s = {{side * (2 * u.x - 1), side * (2 * u.y - 1)}, square(random), square(random).x,
                 nm.back(), c.opening};
        }
        std::vector<CameraRay> rays(samples.size());
        generate_rays(c.camera, samples, rays);
        std::vector<Reprojection> back(samples.size());
        reproject(c.camera, rays, nm, back);
        int passed = 0, lost = 0, far = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!(rays[i].weight > 0)) continue;
            ++passed;
            const Reprojection& r = back[i];
            lost += !(r.etendue > 0);   // grazes an edge
            if (!(r.etendue > 0)) continue;
            far += length(r.film_mm - samples[i].film_mm) > 4e-3f;
            CHECK(r.aim_weight * r.transmittance == doctest::Approx(rays[i].weight).epsilon(2e-3));
            CHECK(r.response * r.etendue == doctest::Approx(rays[i].weight).epsilon(2e-3));
        }
        CHECK(passed > 500);
        CHECK(lost <= passed / 300 + 2);
        CHECK(far <= passed / 300);
    }
}

TEST_CASE("light rays and camera rays bring the same light to the same film; 2 % less is noticed") {
    std::vector<double> cells, totals, dimmed, unused;
    unsigned seed = 1;
    for (const test::ViewCase& c : test::view_cases())
        for (const test::ViewPoint& p : c.points) {
            CAPTURE(c.name);
            CAPTURE(p.at.x);
            CAPTURE(p.at.z);
            CAPTURE(p.w);
            const Emitter e(p.at, p.w, p.half, Vec3d{-p.at.x, 0.3 * p.at.z, -p.at.z});
            const auto light = by_light(c, e, 60000, ++seed);
            const Rectangle film = around(light);
            REQUIRE(film.area() > 0);
            const auto camera = by_camera(c, e, film, 250000, ++seed);
            std::vector<double> own, total;
            compare(per_cell(light, film), per_cell(camera, film), own, total);
            CHECK(total.size() == 1);
            CHECK(chi_square_p(own) > 1e-5);
            if (!total.empty()) CHECK(std::abs(total[0]) < 4.5);
            cells.insert(cells.end(), own.begin(), own.end());
            totals.insert(totals.end(), total.begin(), total.end());
            compare(per_cell(light, film, 0.98), per_cell(camera, film), unused, dimmed);
            if (std::getenv("VIEW_VERBOSE")) {
                int hit = 0;
                for (const Found& f : light) hit += f.light > 0;
                double rms = 0;
                for (double z : own) rms += z * z;
                const auto m = per_cell(light, film), n = per_cell(camera, film);
                std::printf("%-28s (%7.3f %7.3f %8.3f) %g pass %.3f cells %zu rms %.2f total %.2f ratio %.4f +- %.4f\n",
                            c.name.c_str(), p.at.x, p.at.y, p.at.z, p.w, hit / 60000.,
                            own.size(), std::sqrt(rms / own.size()), total.empty() ? 99 : total[0],
                            m.back().mean / n.back().mean,
                            std::sqrt(m.back().variance / m.back().count) / m.back().mean +
                                std::sqrt(n.back().variance / n.back().count) / n.back().mean);
            }
        }
    CHECK(chi_square_p(cells) > 1e-4);
    CHECK(chi_square_p(totals) > 1e-4);
    CHECK(chi_square_p(dimmed) < 1e-6);
}

TEST_CASE("what the camera draws lies in the region, seen from any point of its ray") {
    for (const test::ViewCase& c : test::view_cases()) {
        CAPTURE(c.name);
        Random random(5);
        const float side = c.half_diagonal_mm * 0.7f;
        const int count = 100000;
        std::vector<CameraSample> samples(count);
        for (int i = 0; i < count; ++i) {
            const Vec2f u = square(random);
            samples[i] = {{side * (2 * u.x - 1), side * (2 * u.y - 1)}, square(random), square(random).x,
                          380 + 400 * square(random).x, c.opening};
        }
        std::vector<CameraRay> rays(count);
        generate_rays(c.camera, samples, rays);
        const PupilViewOverTime view(c.camera);
        int passed = 0, missed = 0, at_infinity = 0;
        for (int i = 0; i < count; ++i) {
            if (!(rays[i].weight > 0)) continue;
            const double t = 0.1 * std::pow(1e3, square(random).x);
            const Vec3d o = to_double(rays[i].ray.origin), d = to_double(rays[i].ray.direction);
            ++passed;
            missed += !(view.pdf(o + d * t, 1, rays[i].ray) > 0);
            at_infinity += !(view.pdf(d, 0, rays[i].ray) > 0);
        }
        if (std::getenv("VIEW_VERBOSE"))
            std::printf("%-28s missed %d + %d of %d\n", c.name.c_str(), missed, at_infinity, passed);
        CHECK(missed + at_infinity <= passed / 5000);
    }
}

// By rays toward a disc across the direction to the point, all alike.
TEST_CASE("the density integrates to one, and is that of what is drawn") {
    for (const test::ViewCase& c : test::view_cases()) {
        if (std::holds_alternative<Pinhole>(c.camera.lens)) continue;
        for (const test::ViewPoint& p : c.points) {
            CAPTURE(c.name);
            CAPTURE(p.at.x);
            CAPTURE(p.w);
            Random random(7);
            const PupilViewOverTime view(c.camera);
            const Vec3d e = normalize(p.at), x = normalize(cross(Vec3d{0.3, 1, 0.2}, e)), y = cross(e, x);
            Vec3d sum{};
            double reach = 0;
            std::vector<Vec3d> met;
            for (int i = 0; i < 2000; ++i) {
                const float time = square(random).x;
                const auto s = view.sample(p.at, p.w, square(random), time);
                if (!s) continue;
                const Ray ray{.origin = s->origin, .direction = s->direction, .time = time};
                CHECK(view.pdf(p.at, p.w, ray) == doctest::Approx(s->pdf).epsilon(1e-4));
                const Vec3d o = to_double(s->origin), d = to_double(s->direction);
                met.push_back(o - d * (dot(o, e) / dot(d, e)));
                sum += met.back();
            }
            REQUIRE(met.size() > 1000);
            const Vec3d middle = sum * (1.0 / double(met.size()));
            for (const Vec3d& q : met) reach = std::max(reach, 1.2 * length(q - middle));
            double total = 0, squares = 0;
            const int count = 40000;
            for (int i = 0; i < count; ++i) {
                const Vec2d u = reach * concentric_disc({square(random).x, square(random).y});
                const Vec3d q = middle + x * u.x + y * u.y, way = p.at - p.w * q;
                const double far = length(way), cosine = dot(way, e) / far;
                const Ray ray{.origin = to_float(q), .direction = to_float(way * (1 / far)),
                              .time = square(random).x};
                const double f = view.pdf(p.at, p.w, ray) * kPiD * reach * reach *
                                 (p.w == 0 ? 1 : cosine / (far * far));
                total += f, squares += f * f;
            }
            const double mean = total / count;
            CHECK(std::abs(mean - 1) < 4.5 * std::sqrt((squares / count - mean * mean) / count) + 1e-4);
        }
    }
}
