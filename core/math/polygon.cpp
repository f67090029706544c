// polygon.cpp -- one edge in its own frame: the middle of the chord at (apothem, 0), the
// chord along y.
//
// With k = 1 / radius and h = half the chord, the arc is x(y) = apothem + sag(y),
//     sag(y) = (sqrt(1 - k^2 y^2) - sqrt(1 - k^2 h^2)) / k = k (h^2 - y^2) / (sum of the
//     two roots),
// the second form being good for every k including 0. The area between the centre and the
// arc from 0 to y is A(y) = integral of x dy - x y / 2, and grows by dA/dy = (x - y
// dx/dy) / 2.
#include "math/polygon.h"

#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

/// Integral of sqrt(1 - t^2) from 0 to z, minus z: -z^3/6 - z^5/40 - ...; the difference
/// is formed by its series where it would cancel.
double root_integral_minus_z(double z) {
    if (std::abs(z) > 0.1) return 0.5 * (std::asin(z) + z * std::sqrt(1 - z * z)) - z;
    const double q = z * z;
    double term = -z * q / 2, sum = term / 3;  // term: binomial(1/2, n) (-1)^n z^(2n+1)
    for (int n = 2; n < 8; ++n) {
        term *= q * (2 * n - 3) / (2 * n);
        sum += term / (2 * n + 1);
    }
    return sum;
}

}  // namespace

CurvedPolygon::CurvedPolygon(int blades, double rotation_rad, double curvature)
    : blades_(blades), rotation_(rotation_rad), half_angle_(kPiD / blades) {
    if (blades < 3)
        throw input_error("iris", "blades", "at least 3", std::to_string(blades));
    if (!(std::abs(curvature) <= 1))
        throw input_error("iris", "blade curvature", "-1 to 1",
                          std::to_string(curvature));
    if (!std::isfinite(rotation_rad))
        throw input_error("iris", "rotation", "a finite angle",
                          std::to_string(rotation_rad));
    apothem_ = std::cos(half_angle_);
    half_edge_ = std::sin(half_angle_);
    // A triangle's corners are too sharp for the mirrored arc: its arcs would cross
    // beyond the bend that turns corners into cusps, where the arc leaves the chord at
    // half the corner's angle.
    const double cusp = half_edge_ * std::tan((kPiD / 2 - half_angle_) / 2);
    const double out = 1 - apothem_, in = std::min(out, cusp);
    const double sagitta = curvature * (curvature > 0 ? out : in);
    bend_ = 2 * sagitta / (half_edge_ * half_edge_ + sagitta * sagitta);
    half_sector_ = swept_half(half_edge_);
    area_ = 2 * half_sector_ * blades_;
}

double CurvedPolygon::edge(double y) const {
    const double k = bend_, h = half_edge_;
    return apothem_ + k * (h * h - y * y) /
                          (std::sqrt(1 - k * k * y * y) + std::sqrt(1 - k * k * h * h));
}

double CurvedPolygon::swept_half(double y) const {
    const double k = bend_, h = half_edge_;
    // 1 - sqrt(1 - k^2 h^2), over k: what the roots of the sag differ from 1 by.
    const double chord = k * h * h / (1 + std::sqrt(1 - k * k * h * h));
    const double bulge = k == 0 ? 0 : root_integral_minus_z(k * y) / (k * k) + y * chord;
    return apothem_ * y + bulge - 0.5 * edge(y) * y;
}

Vec2f CurvedPolygon::sample(Vec2f u) const {
    const double along = double(u.x) * blades_;
    const int blade = std::min(int(along), blades_ - 1);
    const double target = (2 * (along - blade) - 1) * half_sector_;
    // Newton inside a bracket: A grows, but not strictly where an inward arc meets the
    // centre.
    double low = -half_edge_, high = half_edge_,
           y = (2 * (along - blade) - 1) * half_edge_;
    for (int i = 0; i < 40; ++i) {
        const double error = swept_half(y) - target;
        if (std::abs(error) < 1e-10 * half_sector_) break;
        (error > 0 ? high : low) = y;
        const double slope =
            0.5 * (edge(y) + bend_ * y * y / std::sqrt(1 - bend_ * bend_ * y * y));
        const double next = y - error / slope;
        y = next > low && next < high ? next : 0.5 * (low + high);
    }
    const double r = std::sqrt(double(u.y));
    const double angle = rotation_ + (2 * blade + 1) * half_angle_;
    const double c = std::cos(angle), s = std::sin(angle), x = edge(y);
    return {float(r * (c * x - s * y)), float(r * (s * x + c * y))};
}

bool CurvedPolygon::contains(Vec2f p) const {
    const double sector =
        (std::atan2(double(p.y), double(p.x)) - rotation_) / (2 * half_angle_);
    const double angle = rotation_ + (2 * std::floor(sector) + 1) * half_angle_;
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = c * p.x + s * p.y, y = c * p.y - s * p.x;
    // Inside or outside of the arc's circle, multiplied out so that k = 0 is the straight
    // edge. An inward circle is passed again farther out: the polygon ends the search.
    const double dx = x - edge(0);
    const bool within_arc = 2 * dx + bend_ * (dx * dx + y * y) <= 0;
    return within_arc && (bend_ >= 0 || x <= apothem_);
}

}  // namespace dg
