#include "optics/expansion/lens_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dg {
namespace {

constexpr int kNewtonSteps = 12;

/// sin(t) / t, (1 - cos(t)) / t^2 and tan(t / 2) / t, with their limits at t = 0.
struct AngleRatios {
    double sine, versine, half_tangent;
    explicit AngleRatios(double t) {
        const double h = t / 2, s = t > 1e-6 ? std::sin(h) / h : 1;  // sine ratio of the half angle
        sine = t > 1e-6 ? std::sin(t) / t : 1;
        versine = s * s / 2;
        half_tangent = t > 1e-6 ? std::tan(h) / t : 0.5;
    }
};

/// Solves a x = b by Gaussian elimination with pivoting. Returns false for a singular matrix.
bool solve4(std::array<std::array<double, 5>, 4>& a, std::array<double, 4>& x) {
    for (int k = 0; k < 4; ++k) {
        int pivot = k;
        for (int i = k + 1; i < 4; ++i)
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        std::swap(a[k], a[pivot]);
        if (!(std::abs(a[k][k]) > 1e-300)) return false;
        for (int i = k + 1; i < 4; ++i) {
            const double factor = a[i][k] / a[k][k];
            for (int j = k; j < 5; ++j) a[i][j] -= factor * a[k][j];
        }
    }
    for (int k = 3; k >= 0; --k) {
        double sum = a[k][4];
        for (int j = k + 1; j < 4; ++j) sum -= a[k][j] * x[j];
        x[k] = sum / a[k][k];
    }
    return true;
}

using Four = std::array<double, 4>;

Four scene_of(const LensFit& fit, const Four& z, double l) {
    const Vec2d f{z[0], z[1]};
    const FitDirection d = fit.scene_vectors(fit.segment_at(f), f, {z[2], z[3]}, l);
    return {d.direction.x, d.direction.y, d.offset.x, d.offset.y};
}

/// Newton step with derivatives by central differences; the reference need not be fast.
bool newton_step(const LensFit& fit, const Four& target, double l, Four& z) {
    constexpr double h = 1e-5;
    const Four now = scene_of(fit, z, l);
    std::array<std::array<double, 5>, 4> a{};
    for (int k = 0; k < 4; ++k) {
        Four up = z, down = z;
        up[k] += h, down[k] -= h;
        const Four above = scene_of(fit, up, l), below = scene_of(fit, down, l);
        for (int i = 0; i < 4; ++i) a[i][k] = (above[i] - below[i]) / (2 * h);
    }
    for (int i = 0; i < 4; ++i) a[i][4] = target[i] - now[i];
    Four step{};
    if (!solve4(a, step)) return false;
    for (int k = 0; k < 4; ++k) z[k] += step[k];
    return true;
}

}  // namespace

void block_vectors(const FitBlock& block, const FitVariables& at, bool axial, Vec2d f,
                   Vec2d q, Vec2d* out) {
    std::vector<double> x(block.x.count), y(block.y.count);
    block.x.evaluate(at, x.data());
    if (!axial) block.y.evaluate(at, y.data());
    const int count = axial ? block.x.count / 2 : block.x.count;
    for (int i = 0; i < count; ++i)
        out[i] = axial ? f * x[2 * i] + q * x[2 * i + 1] : Vec2d{x[i], y[i]};
}

FitDirection describe_ray(const LensRay& scene, double pupil_z) {
    const Vec3d d = scene.direction;
    const double sine = hypot(d.x, d.y), theta = atan2(sine, -d.z);
    const AngleRatios ratio(theta);
    const Vec2d v = Vec2d{d.x, d.y} * (1 / ratio.sine);
    const Vec3d from = scene.origin - Vec3d{0, 0, pupil_z};
    const Vec3d p = from - d * dot(from, d);
    // Inverse of the rotation: e = p - (p.a)(a + d) / (1 + a.d), a = (0, 0, -1).
    return {v, Vec2d{p.x, p.y} + v * (p.z * ratio.half_tangent)};
}

Vec2d LensFit::unit_film(Vec2d p) const {
    return {(p.x - film_center.x) / film_half.x, (p.y - film_center.y) / film_half.y};
}

Vec2d LensFit::bent(const FitSegment& g, Vec2d f, Vec2d q, double l) const {
    if (g.bend.x.count == 0) return q;
    Vec2d bend;
    block_vectors(g.bend, variables(f, q, l, g), symmetry.axial, f, q, &bend);
    return q + bend;
}

FitVariables LensFit::variables(Vec2d f, Vec2d q, double l, const FitSegment& g) const {
    if (!symmetry.axial) return {q.x, q.y, f.x, f.y, l};
    const double u = (2 * dot(f, f) - g.u_low - g.u_high) / (g.u_high - g.u_low);
    return {dot(f, q), 2 * dot(q, q) - 1, u, l, 0};
}

const FitSegment& LensFit::segment_at(Vec2d f) const {
    const double u = dot(f, f);
    for (const FitSegment& s : segments)
        if (u < s.u_high) return s;
    return segments.back();
}

Vec2d LensFit::direction(const FitSegment& g, Vec2d f, Vec2d q, double l) const {
    const Vec2d b = bent(g, f, q, l);
    Vec2d v;
    block_vectors(g.direction, variables(f, b, l, g), symmetry.axial, f, b, &v);
    return v;
}

FitDirection LensFit::scene_vectors(const FitSegment& segment, Vec2d f, Vec2d q,
                                    double l) const {
    std::vector<Vec2d> points(2 + mounts.size());
    block_vectors(segment.points, variables(f, q, l, segment), symmetry.axial, f, q,
                  points.data());
    return {direction(segment, f, q, l), points[0]};
}

FitValue LensFit::evaluate(const FitRay& ray) const {
    const Vec2d f = unit_film(ray.film), q = pupil.q(f, ray.slope);
    const FitSegment& segment = segment_at(f);
    const double l = scale(ray.wavelength_nm);
    const FitVariables at = variables(f, q, l, segment);
    std::vector<Vec2d> points(2 + mounts.size());
    block_vectors(segment.points, at, symmetry.axial, f, q, points.data());
    FitValue value;
    value.direction = direction(segment, f, q, l);
    value.offset = points[0], value.iris = points[1];
    value.mounts.assign(points.begin() + 2, points.end());
    segment.light.x.evaluate(at, &value.transmittance);
    value.within =
        dot(q, q) <= 1 &&
        (symmetry.axial ? dot(f, f) <= 1 : std::max(std::abs(f.x), std::abs(f.y)) <= 1);
    for (std::size_t i = 0; i < mounts.size(); ++i) {
        const double r = length(value.mounts[i]);
        value.within = value.within && r <= mounts[i].radius && r >= mounts[i].inner;
    }
    return value;
}

LensRay LensFit::scene_ray(Vec2d v, Vec2d e) const {
    const double theta = length(v);
    const AngleRatios ratio(theta);
    const Vec3d d{v.x * ratio.sine, v.y * ratio.sine, -std::cos(theta)};
    const double along = dot(e, v);
    const Vec2d across = e - v * (along * ratio.versine);
    const Vec3d foot{across.x, across.y, entrance_pupil_z - front_z + along * ratio.sine};
    // c |p + t d|^2 = 2 (p + t d).z about the vertex; this form of the root is stable for planes.
    const double c = front_curvature, b = c * dot(foot, d) - d.z,
                 k = c * dot(foot, foot) - 2 * foot.z;
    const double root = b * b - c * k;
    const double t = root > 0 ? -k / (b + std::sqrt(root)) : 0;
    return {foot + d * t + Vec3d{0, 0, front_z}, d};
}

LensRay LensFit::film_ray(const FitRay& ray) const {
    return {film.at(ray.film), normalize(Vec3d{-ray.slope.x, -ray.slope.y, -1})};
}

std::optional<FitRay> LensFit::to_film(const LensRay& scene, double nm) const {
    const FitDirection d = describe_ray(scene, entrance_pupil_z);
    const double l = scale(nm);
    const Vec2d g = d.direction * (1 / inverse.direction),
                h = inverse.pupil.q(g, d.offset);
    Vec2d start[2];
    const FitVariables at = symmetry.axial ? FitVariables{dot(g, h), 2 * dot(h, h) - 1,
                                                          2 * dot(g, g) - 1, l, 0}
                                           : FitVariables{h.x, h.y, g.x, g.y, l};
    block_vectors(inverse.rays, at, symmetry.axial, g, h, start);
    Four z{start[0].x, start[0].y, start[1].x, start[1].y};
    const Four target{d.direction.x, d.direction.y, d.offset.x, d.offset.y};
    for (int i = 0; i < kNewtonSteps; ++i) {
        const Four before = z;
        if (!newton_step(*this, target, l, z)) return std::nullopt;
        double moved = 0, size = 0;
        for (int k = 0; k < 4; ++k)
            moved = std::max(moved, std::abs(z[k] - before[k])),
            size = std::max(size, std::abs(z[k]));
        if (!(size < 4)) return std::nullopt;
        if (moved > 1e-12) continue;
        const Vec2d f{z[0], z[1]};
        return FitRay{
            {film_center.x + film_half.x * f.x, film_center.y + film_half.y * f.y},
            pupil.slope(f, {z[2], z[3]}),
            nm};
    }
    return std::nullopt;
}

}  // namespace dg
