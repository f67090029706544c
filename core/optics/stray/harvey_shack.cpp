#include "optics/stray/harvey_shack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr double kInverseSquare = 1e-6;   // slopes this close to -2 integrate to a logarithm

double square(double x) {
    return x * x;
}

/// Unit vectors over half of the azimuth.
template <int kCount>
std::array<Vec2d, kCount> half_circle() {
    std::array<Vec2d, kCount> directions;
    for (int k = 0; k < kCount; ++k) {
        const double phi = kPiD * (k + 0.5) / kCount;
        directions[k] = {std::cos(phi), std::sin(phi)};
    }
    return directions;
}

/// Distance from a point in a disc of radius n to its edge along a unit vector: the positive root
/// of |p + t d| = n.
double to_edge(Vec2d p, Vec2d d, double n) {
    const double along = dot(p, d);
    return std::sqrt(std::max(0.0, n * n - dot(p, p) + along * along)) - along;
}

}  // namespace

double HarveyShack::at(double r) const {
    return std::pow(1 + square(r / knee), 0.5 * slope);
}

double HarveyShack::within(double r) const {
    const double area = kPiD * knee * knee, power = 0.5 * slope + 1, x = square(r / knee);
    if (std::abs(power) < kInverseSquare) return area * std::log1p(x);
    return area * std::expm1(power * std::log1p(x)) / power;
}

double HarveyShack::radius(double u, double most) const {
    const double power = 0.5 * slope + 1, full = std::log1p(square(most / knee));
    const double log = std::abs(power) < kInverseSquare
                           ? u * full
                           : std::log1p(u * std::expm1(power * full)) / power;
    return knee * std::sqrt(std::max(0.0, std::expm1(log)));
}

/// Mean of within() over all azimuths about the lobe's centre. The integrand is smooth and
/// periodic, so the error falls as (offset / n)^(2 azimuths).
double HarveyShack::over_directions(double offset, double n) const {
    static const std::array coarse = half_circle<8>();
    static const std::array fine = half_circle<32>();
    const std::span<const Vec2d> directions = offset < 0.5 * n ? std::span<const Vec2d>(coarse) : fine;
    double sum = 0;
    for (const Vec2d way : directions) sum += within(to_edge({offset, 0}, way, n));
    return sum / double(directions.size());
}

Vec2d HarveyShack::sample(Vec2d middle, double n, Vec2d u) const {
    const double phi = 2 * kPiD * u.y;
    const Vec2d way{std::cos(phi), std::sin(phi)};
    return middle + way * radius(u.x, to_edge(middle, way, n));
}

double HarveyShack::pdf(Vec2d middle, double n, Vec2d p) const {
    if (!(dot(p, p) <= n * n)) return 0;
    const Vec2d from = p - middle;
    const double r = length(from);
    const Vec2d way = r > 0 ? from * (1 / r) : Vec2d{1, 0};
    return at(r) / within(to_edge(middle, way, n));
}

void check_lobe(const HarveyShack& lobe, const char* where) {
    if (!(lobe.knee >= 1e-4 && lobe.knee <= 1))
        throw input_error("scatter", std::string(where) + ", knee", "1e-4 to 1", std::to_string(lobe.knee));
    if (!(lobe.slope >= -4 && lobe.slope <= -0.5))
        throw input_error("scatter", std::string(where) + ", slope", "-4 to -0.5",
                          std::to_string(lobe.slope));
}

double total_integrated_scatter(double rms_nm, double step, double wavelength_nm) {
    return -std::expm1(-square(2 * kPiD * rms_nm * step / wavelength_nm));
}

}  // namespace dg
