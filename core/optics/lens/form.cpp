#include "optics/lens/form.h"

#include <algorithm>

namespace dg {
namespace {

/// Sets the axes to the columns of Rx Ry Rz: rotations about x, then about the rotated y, then
/// about the rotated z, as in lens design programs. Right-handed, degrees.
void turn(SurfaceFrame& p, Vec3d degrees) {
    const double rad = kPiD / 180;
    const double ca = std::cos(degrees.x * rad), sa = std::sin(degrees.x * rad);
    const double cb = std::cos(degrees.y * rad), sb = std::sin(degrees.y * rad);
    const double cc = std::cos(degrees.z * rad), sc = std::sin(degrees.z * rad);
    p.turned = true;
    p.x = {cb * cc, ca * sc + sa * sb * cc, sa * sc - ca * sb * cc};
    p.y = {-cb * sc, ca * cc - sa * sb * sc, sa * cc + ca * sb * sc};
    p.z = {sb, -sa * cb, ca * cb};
}

void set_asphere(SurfaceForm& f, const std::vector<AsphereTerm>& terms) {
    for (const AsphereTerm& a : terms) {
        if (a.coefficient == 0) continue;
        std::vector<double>& list = a.power % 2 ? f.odd : f.even;
        const std::size_t j = std::size_t((a.power - 1) / 2);
        if (list.size() <= j) list.resize(j + 1);
        list[j] += a.coefficient;
    }
}

void set_quadric(SurfaceForm& f) {
    f.quadric = f.even.empty() && f.odd.empty() &&
                (f.shape == Shape::conic || f.cx == 0 || f.cy == 0);
    if (f.shape == Shape::conic) {
        f.c = f.cy, f.k = f.ky;
    } else {
        const bool power_y = f.cy != 0;
        f.c = power_y ? f.cy : f.cx, f.k = power_y ? f.ky : f.kx;
        f.wx = power_y ? 0 : 1, f.wy = power_y ? 1 : 0;
    }
    f.sphere = f.quadric && f.shape == Shape::conic && f.ky == 0;
}

/// Sets bounds of |sag| and slope: maxima over a fine grid of the clear disc, with a margin for
/// points between its nodes. The bounds are infinite if the sag is undefined anywhere on the grid.
void set_bounds(SurfaceForm& f) {
    constexpr int kRings = 96;
    const int spokes = f.shape == Shape::conic ? 1 : 17;  // one quadrant: sections are even in x and y
    const double infinity = std::numeric_limits<double>::infinity();
    f.height = f.slope = infinity;
    if (!std::isfinite(f.clear)) return;
    double height = 0, slope = 0;
    for (int spoke = 0; spoke < spokes; ++spoke) {
        const double angle = 0.5 * kPiD * spoke / std::max(1, spokes - 1);
        for (int ring = 0; ring <= kRings; ++ring) {
            const double r =
                (1 - 1e-6) * f.clear * ring / kRings;  // the slope may be infinite at the rim
            const Sag<double> s = sag(f, r * std::cos(angle), r * std::sin(angle));
            if (!s.defined) return;
            height = std::max(height, std::abs(s.z));
            slope = std::max(slope, hypot(s.slope_x, s.slope_y));
        }
    }
    f.slope = 1.05 * slope;
    f.height = height + f.slope * f.clear / kRings;
}

}  // namespace

SurfaceForm::SurfaceForm(const Surface& s, double vertex_z) : shape(s.shape) {
    cy = s.curvature, ky = s.conic;
    const bool round = s.shape == Shape::conic;
    cx = round ? cy : s.curvature_x, kx = round ? ky : s.conic_x;
    set_asphere(*this, s.asphere);
    set_quadric(*this);
    clear = clear_radius(s);
    if (!quadric) set_bounds(*this);
    place.origin = {s.decenter.x, s.decenter.y, vertex_z + s.decenter.z};
    if (s.tilt != Vec3d{}) turn(place, s.tilt);
    ripple = RippleSlope(s.ripple, clear);
}

}  // namespace dg
