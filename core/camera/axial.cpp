#include "camera/axial.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dg {
namespace {

/// Bisects for the largest s in [0, 0.999] such that `inside` holds up to s.
template <typename Inside>
double edge(const Inside& inside, int steps) {
    double low = 0, high = 0.999;
    for (int i = 0; i < steps; ++i) {
        const double middle = 0.5 * (low + high);
        (inside(middle) ? low : high) = middle;
    }
    return low;
}

// Chebyshev points: few suffice to interpolate a smooth function. Source: Berrut and Trefethen
// 2004.
constexpr int kNodes = 16;

double node(int j) {
    return 0.5 - 0.5 * std::cos(kPiD * (2 * j + 1) / (2 * kNodes));
}

/// Barycentric interpolation of both components of the values `at` the nodes, x in [0, 1].
Vec2d interpolate(const std::array<Vec2d, kNodes>& at, double x) {
    Vec2d sum{};
    double weights = 0;
    for (int j = 0; j < kNodes; ++j) {
        const double away = x - node(j);
        if (away == 0) return at[j];
        const double w = (j % 2 ? -1 : 1) * std::sin(kPiD * (2 * j + 1) / (2 * kNodes)) / away;
        sum = sum + w * at[j];
        weights += w;
    }
    return sum * (1 / weights);
}

}  // namespace

// E = integral L cos dw = pi * integral L d(sin^2 theta). Rotational symmetry leaves one meridional
// ray per angle, weighted by the open fraction of the iris on its circle. Midpoint rule in sin^2 up
// to the widest passing ray; the iris radius and T are smooth in it, so few rays are traced.
double axial_irradiance(const Tracer& tracer, double film_z, const RadialOpening& opening,
                        double iris_radius, double wavelength_nm, bool perfect) {
    const LensIndices n = tracer.at(wavelength_nm);
    const double outer = opening.outer() * iris_radius;
    const auto ray_at = [&](double s2) {
        const LensRay ray{{0, 0, film_z}, {-std::sqrt(s2), 0, -std::sqrt(1 - s2)}};
        return tracer.to_scene(ray, n, {true, nullptr, 0});
    };
    const double widest = edge(
        [&](double s2) {
            const auto ray = ray_at(s2);
            return ray && std::abs(ray->iris.x) <= outer;
        },
        40);
    std::array<Vec2d, kNodes> traced;  // (iris radius / sine)^2 is smooth even on the axis
    for (int j = 0; j < kNodes; ++j) {
        const double s2 = widest * node(j);
        const auto ray = ray_at(s2);
        if (!ray) return 0;
        traced[j] = {ray->iris.x * ray->iris.x / s2, perfect ? 1 : ray->transmittance};
    }
    constexpr int kSteps = 256;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = (i + 0.5) / kSteps;
        const Vec2d there = interpolate(traced, x);
        sum += there.y * opening.at(std::sqrt(std::max(0.0, there.x * widest * x)) / iris_radius);
    }
    return kPiD * widest * sum / kSteps;
}

// dw = du dphi / (2 cos alpha), u = sin^2 of the angle alpha to the chief ray: midpoint rule in u
// up to the edge, which is searched for each azimuth. Image-shaped irises have edges inside and
// need many steps.
double axial_irradiance(const Tracer& tracer, double film_z, const Iris& iris, double iris_radius,
                        Vec2d chief, double wavelength_nm, bool perfect) {
    const bool picture = iris.kind() == Iris::Kind::image;
    const int turns = 120, steps = picture ? 64 : 12;
    const LensIndices n = tracer.at(wavelength_nm);
    const Vec3d pole = normalize(Vec3d{-chief.x, -chief.y, -1});
    const Vec3d side = normalize(cross(pole, Vec3d{0, 1, 0})), up = cross(side, pole);
    const double outer = iris.outer_radius() * iris_radius;
    double sum = 0;
    for (int turn = 0; turn < turns; ++turn) {
        const double phi = 2 * kPiD * (turn + 0.5) / turns;
        const Vec3d across = std::cos(phi) * side + std::sin(phi) * up;
        const auto toward = [&](double u) { return std::sqrt(1 - u) * pole + std::sqrt(u) * across; };
        const auto open = [&](double u, bool edges_only) {
            const auto ray = tracer.to_scene({{0, 0, film_z}, toward(u)}, n, {true, nullptr, 0});
            if (!ray || length(ray->iris) > outer) return 0.0;
            const double through =
                picture && edges_only ? 1 : iris.transmission(ray->iris * (1 / iris_radius));
            return through * (perfect ? 1 : ray->transmittance);
        };
        const double widest = edge([&](double u) { return open(u, true) > 0; }, 30);
        for (int i = 0; i < steps; ++i) {
            const double u = widest * (i + 0.5) / steps;
            sum += widest / steps * open(u, false) * -toward(u).z / (2 * std::sqrt(1 - u));
        }
    }
    return 2 * kPiD * sum / turns;
}

}  // namespace dg
