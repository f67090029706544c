// Camera rays and light rays through a lens bring the same light to a part of the film.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "camera/inverse/pupil_view.h"
#include "camera/inverse/view_cases.h"
#include "math/statistics.h"

using namespace dg;
using test::Random, test::square, test::wavelength;

namespace {

struct Emitter {
    Vec3d center, x, y, normal;
    double w, half;

    /// `half`: m, or the tangent of the angle for an emitter at infinity.
    Emitter(Vec3d p, double w, double half, Vec3d facing)
        : center(w == 0 ? normalize(p) : p), w(w), half(half) {
        normal = normalize(w == 0 ? -center : facing);
        x = normalize(cross(Vec3d{0.3, 1, 0.2}, normal)), y = cross(normal, x);
    }
    Vec3d at(Vec2f u) const {
        return center + x * ((2 * u.x - 1) * half) + y * ((2 * u.y - 1) * half);
    }
    bool meets(const Ray& ray) const {
        const Vec3d d = to_double(ray.direction),
                    o = w == 0 ? Vec3d{} : to_double(ray.origin);
        const double along = dot(d, normal), t = dot(center - o, normal) / along;
        if (!(along < 0 && t > 0)) return false;
        const Vec3d hit = o + d * t - center;
        return std::abs(dot(hit, x)) < half && std::abs(dot(hit, y)) < half;
    }
};

struct Found {
    Vec2f film_mm;
    double light;  // relative exposure x mm2
};

CameraRay camera_ray(const PupilView::Sample& s, float time, float opening) {
    CameraRay r;
    r.ray = Ray{.origin = s.origin, .direction = s.direction, .time = time};
    r.iris_opening = opening;
    return r;
}

std::vector<Found> by_light(const test::ViewCase& c, const PupilViewOverTime& view,
                            const Emitter& e, int count, unsigned seed) {
    Random random(seed);
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
        // Solid angle of a patch of the square at infinity: cos^3 times its area.
        const double factor = e.w == 0 ? cosine * cosine * cosine : std::max(0.0, cosine);
        found[i].light = side * side * factor / s->pdf;
    }
    std::vector<Reprojection> film(count);
    reproject(c.camera, rays, nm, film);
    for (int i = 0; i < count; ++i) {
        found[i].film_mm = film[i].film_mm;
        found[i].light *= film[i].response;
        if (!(found[i].light > 0) || !c.on_film(film[i].film_mm)) found[i] = {};
    }
    return found;
}

struct Rectangle {
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};
    double area() const { return double(high.x - low.x) * (high.y - low.y); }
    int cell(Vec2f p, int side) const {
        const float x = (p.x - low.x) / (high.x - low.x),
                    y = (p.y - low.y) / (high.y - low.y);
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

std::vector<Found> by_camera(const test::ViewCase& c, const Emitter& e,
                             const Rectangle& film, int count, unsigned seed) {
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
        if (rays[i].weight > 0 && c.on_film(samples[i].film_mm) && e.meets(rays[i].ray))
            found[i] = {samples[i].film_mm, rays[i].weight * film.area()};
    return found;
}

constexpr int kSide = 3;

std::vector<SampleMoments> per_cell(const std::vector<Found>& found,
                                    const Rectangle& film, double factor = 1) {
    std::vector<double> sum(kSide * kSide + 1), squares(kSide * kSide + 1);
    for (const Found& f : found) {
        const int cell = film.cell(f.film_mm, kSide);
        if (cell < 0 || !(f.light > 0)) continue;
        const double light = factor * f.light;
        for (const int k : {cell, kSide * kSide})
            sum[k] += light, squares[k] += light * light;
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
        // Means of few hits are not normally distributed.
        const auto many = [](const SampleMoments& m) {
            return m.mean * m.mean * m.count > 40 * m.variance;
        };
        if (!many(a[k]) || !many(b[k])) continue;
        const double e2 = a[k].variance / a[k].count + b[k].variance / b[k].count;
        (k + 1 == a.size() ? totals : cells)
            .push_back((a[k].mean - b[k].mean) / std::sqrt(e2));
    }
}

double chi_square_p(const std::vector<double>& z) {
    double sum = 0;
    for (const double s : z) sum += s * s;
    return chi_square_tail(sum, double(z.size()));
}

}  // namespace

TEST_CASE(
    "light rays and camera rays bring the same light to the same film; 2 % less is "
    "noticed") {
    std::vector<double> cells, totals, dimmed, unused;
    unsigned seed = 1;
    for (const test::ViewCase& c : test::view_cases()) {
        const PupilViewOverTime view(c.camera);
        for (const test::ViewPoint& p : c.points) {
            CAPTURE(c.name);
            CAPTURE(p.at.x);
            CAPTURE(p.at.z);
            CAPTURE(p.w);
            const Emitter e(p.at, p.w, p.half, Vec3d{-p.at.x, 0.3 * p.at.z, -p.at.z});
            const auto light = by_light(c, view, e, 60000, ++seed);
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
                std::printf(
                    "%-28s (%7.3f %7.3f %8.3f) %g pass %.3f cells %zu rms %.2f total "
                    "%.2f ratio %.4f +- %.4f\n",
                    c.name.c_str(), p.at.x, p.at.y, p.at.z, p.w, hit / 60000., own.size(),
                    std::sqrt(rms / own.size()), total.empty() ? 99 : total[0],
                    m.back().mean / n.back().mean,
                    std::sqrt(m.back().variance / m.back().count) / m.back().mean +
                        std::sqrt(n.back().variance / n.back().count) / n.back().mean);
            }
        }
    }
    CHECK(chi_square_p(cells) > 1e-4);
    CHECK(chi_square_p(totals) > 1e-4);
    CHECK(chi_square_p(dimmed) < 1e-6);
}
