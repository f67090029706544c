// round_cone.cpp -- intersection of rays with the convex hull of two balls, in double.
//
// With z along the axis from the first centre and q the distance from the axis, the cone tangent to
// both balls is q c + z m = ra, where its normals are tilted by m = (ra - rb) / l against the axis
// and c = sqrt(1 - m^2). It touches the balls at z = ra m and z = l + rb m; the balls continue the
// surface beyond.
#include "geometry/round_cone.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace dg {
namespace {

struct Shape {
    Vec3d axis;
    double length, lean, across;
    double low, high;  // range of z on the cone

    explicit Shape(const RoundCone& c) {
        const Vec3d way = c.b - c.a;
        length = dg::length(way);
        axis = length > 0 ? way / length : Vec3d{1, 0, 0};
        lean = length > 0 ? (c.ra - c.rb) / length : 0;
        across = std::sqrt(std::max(0.0, 1 - lean * lean));
        low = c.ra * lean, high = length + c.rb * lean;
    }
    /// Whether one ball contains the other.
    bool is_ball() const { return !(length > 0 && std::abs(lean) < 1); }
};

struct Roots {
    double t[2];
};
std::optional<Roots> roots(double a, double half_b, double c) {
    const double d = half_b * half_b - a * c;
    if (!(d >= 0) || a == 0) return std::nullopt;
    const double q = -(half_b + std::copysign(std::sqrt(d), half_b));
    return q == 0 ? Roots{{0, 0}} : Roots{{q / a, c / q}};
}

/// Records the first and the last hit.
class Span {
  public:
    Span(Vec3d origin, Vec3d direction) : origin_(origin), direction_(direction) {}
    Vec3d at(double t) const { return origin_ + direction_ * t; }
    void note(double t, double along, Vec3d normal) {
        if (t < first_.t) first_ = {t, along, at(t), normal};
        if (t > last_.t) last_ = {t, along, at(t), normal};
    }
    RoundConeCrossings found() const {
        if (!(first_.t <= last_.t)) return {};
        return {{first_, last_}, 2};
    }

  private:
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3d origin_, direction_;
    RoundConeCrossing first_{kInfinity, 0, {}, {}}, last_{-kInfinity, 0, {}, {}};
};

void cross_ball(Span& span, Vec3d direction, Vec3d center, double radius, double along,
                const auto& is_ours) {
    const Vec3d from = span.at(0) - center;
    const auto met = roots(dot(direction, direction), dot(from, direction),
                           dot(from, from) - radius * radius);
    if (!met) return;
    for (const double t : met->t) {
        const Vec3d out = span.at(t) - center;
        const double size = length(out);
        if (size > 0 && is_ours(span.at(t))) span.note(t, along, out / size);
    }
}

void cross_side(Span& span, Vec3d direction, const RoundCone& c, const Shape& s, double slack) {
    const Vec3d from = span.at(0) - c.a;
    const double z = dot(from, s.axis), dz = dot(direction, s.axis);
    const Vec3d q = from - s.axis * z, dq = direction - s.axis * dz;
    const double c2 = s.across * s.across, base = c.ra - s.lean * z, grow = -s.lean * dz;
    const auto met = roots(c2 * dot(dq, dq) - grow * grow, c2 * dot(q, dq) - base * grow,
                           c2 * dot(q, q) - base * base);
    if (!met) return;
    for (const double t : met->t) {
        const double at = z + dz * t;
        if (at < s.low - slack || at > s.high + slack) continue;
        const Vec3d out = q + dq * t;
        const double size = length(out);
        if (!(size > 0)) continue;
        const double along = std::clamp((at - s.low) / (s.high - s.low), 0.0, 1.0);
        span.note(t, along, out * (s.across / size) + s.axis * s.lean);
    }
}

}  // namespace

RoundConeCrossings cross_round_cone(const RoundCone& c, Vec3d origin, Vec3d direction) {
    // Shift the origin to the closest approach, so that distance costs no precision.
    const double shift = dot((c.a + c.b) * 0.5 - origin, direction) / dot(direction, direction);
    Span span(origin + direction * shift, direction);
    const Shape s(c);
    const double slack = 1e-12 * (s.length + c.ra + c.rb);  // no crack between the parts
    if (s.is_ball()) {
        const bool second = c.rb > c.ra;
        cross_ball(span, direction, second ? c.b : c.a, std::max(c.ra, c.rb), second ? 1 : 0,
                   [](Vec3d) { return true; });
    } else {
        const auto z = [&](Vec3d p) { return dot(p - c.a, s.axis); };
        cross_ball(span, direction, c.a, c.ra, 0, [&](Vec3d p) { return z(p) <= s.low + slack; });
        cross_ball(span, direction, c.b, c.rb, 1, [&](Vec3d p) { return z(p) >= s.high - slack; });
        cross_side(span, direction, c, s, slack);
    }
    RoundConeCrossings found = span.found();
    for (int i = 0; i < found.count; ++i) found.of[i].t += shift;
    return found;
}

bool RoundCone::holds(Vec3d point, double margin) const {
    const Shape s(*this);
    const Vec3d from = point - a;
    const double z = dot(from, s.axis);
    if (s.is_ball())
        return rb > ra ? length(point - b) < rb - margin : length(from) < ra - margin;
    const double q = length(from - s.axis * z);
    // The ball that touches the surface nearest to the point.
    const double nearest = std::clamp((z - q * s.lean / s.across) / s.length, 0.0, 1.0);
    const double radius = ra + (rb - ra) * nearest;
    return length(from - s.axis * (nearest * s.length)) < radius - margin;
}

}  // namespace dg
